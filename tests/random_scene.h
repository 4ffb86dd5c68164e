// A scene of a few hundred random Gaussians in a file: opened and prepared at once, under sanitizers, too.
#pragma once

#include <filesystem>

#include "scene/formats/scene_file.h"
#include "synthetic_cloud.h"

namespace splatcut::testing {

inline void write_random_scene(const std::filesystem::path& path) {
  constexpr std::size_t kGaussians = 400;
  Scene scene;
  scene.cloud = random_cloud(kGaussians, 11, 1);
  scene.file_rows = kGaussians;
  scene.format = SceneFormat::kSplat;  // not .ply: rows are written, not copied
  save_scene(path, scene, {}, SceneFormat::kPly);
}

}  // namespace splatcut::testing
