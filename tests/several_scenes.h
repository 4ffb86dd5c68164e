// A second scene in the window.
#pragma once

#include <filesystem>
#include <string>

#include "hands.h"
#include "scene/formats/scene_file.h"
#include "synthetic_cloud.h"

namespace splatcut::testing {

inline constexpr std::size_t kAdded = 300;

inline std::filesystem::path small_scene(const ScratchFolder& folder, const std::string& name = "small.ply",
                                         unsigned seed = 1) {
  Scene scene;
  scene.cloud = random_cloud(kAdded, seed, 1);
  scene.file_rows = scene.cloud.size();
  save_scene(folder / name, scene, {}, SceneFormat::kPly);
  return folder / name;
}

inline void add(Hands& hands, const std::filesystem::path& path) {
  hands.studio().apply(AddScene{path});
  REQUIRE(hands.app.settle());
}

inline const SceneSource& last_file(Hands& hands) {
  return hands.studio().scene()->files.back();
}

}  // namespace splatcut::testing
