// A second scene in the window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

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

inline std::vector<std::uint8_t> by_row(const Studio& studio, std::span<const std::uint8_t> flags) {
  const Scene& scene = *studio.scene()->scene;
  std::vector<std::uint8_t> rows(scene.file_rows, 0);
  for (std::size_t g = 0; g < flags.size(); ++g) rows[scene.cloud.file_row[g]] = flags[g];
  return rows;
}

inline std::vector<std::uint8_t> active_by_row(const Studio& studio) {
  return by_row(studio, studio.labels(studio.document().active));
}

inline std::vector<std::uint8_t> longer(std::vector<std::uint8_t> rows, std::size_t by) {
  rows.resize(rows.size() + by, 0);
  return rows;
}

inline bool same_cloud(const GaussianCloud& a, const GaussianCloud& b) {
  return a.position == b.position && a.scale == b.scale && a.rotation == b.rotation &&
         a.opacity == b.opacity && a.f_dc == b.f_dc && a.sh_rest == b.sh_rest && a.file_row == b.file_row &&
         a.near_plane == b.near_plane;
}

}  // namespace splatcut::testing
