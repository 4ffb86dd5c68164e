// Scenes that no training makes, but that a file may hold: their Gaussians fill a cube of 5 units, except
// what the name says.
#pragma once

#include <functional>
#include <limits>

#include "scene/formats/scene_file.h"
#include "synthetic_cloud.h"

namespace splatcut::testing {

struct HostileScene {
  const char* name;
  std::function<void(GaussianCloud&)> make;  // of a cloud in the cube
  bool alone = false;                        // of one Gaussian
};

inline const std::vector<HostileScene>& hostile_scenes() {
  const auto all = [](auto&& change) {
    return [change](GaussianCloud& cloud) {
      for (std::size_t g = 0; g < cloud.size(); ++g) change(cloud, g);
    };
  };
  static const std::vector<HostileScene> scenes = {
      {"one Gaussian", [](GaussianCloud&) {}, true},
      {"one Gaussian without size", [](GaussianCloud& c) { c.scale[0] = glm::vec3(0); }, true},
      {"all in one point", all([](GaussianCloud& c, std::size_t g) { c.position[g] = glm::vec3(1, 2, 3); })},
      {"all on one line",
       all([](GaussianCloud& c, std::size_t g) { c.position[g].y = c.position[g].z = 0; })},
      {"duplicates", all([](GaussianCloud& c, std::size_t g) {
         c.position[g] = c.position[0];
         c.scale[g] = c.scale[0];
         c.rotation[g] = c.rotation[0];
         c.opacity[g] = 0.5f;
         c.f_dc[g] = c.f_dc[0];
       })},
      {"all faint", all([](GaussianCloud& c, std::size_t g) { c.opacity[g] = 0.003f; })},
      {"all huge", all([](GaussianCloud& c, std::size_t g) { c.scale[g] = glm::vec3(100); })},
      {"all huge and nearly faint", all([](GaussianCloud& c, std::size_t g) {
         c.scale[g] = glm::vec3(100);
         c.opacity[g] = 0.006f;
       })},
      {"needles of 70 units", all([](GaussianCloud& c, std::size_t g) {
         c.scale[g] = {70, 0.002f, 0.002f};
       })},
      {"an outlier at 1e9",
       [](GaussianCloud& c) {
         c.position[0] = {1e9f, 0, 0};
       }},
      {"an outlier at 1e14",
       [](GaussianCloud& c) {
         c.position[0] = {0, -1e14f, 0};
       }},
      {"an outlier of 1e9 units at 1e9",
       [](GaussianCloud& c) {
         c.position[0] = {1e9f, 0, 0};
         c.scale[0] = glm::vec3(1e9f);
       }},
      {"one that hides all from within",
       [](GaussianCloud& c) {
         c.position[0] = {0, 0, -6};
         c.scale[0] = glm::vec3(3);
         c.opacity[0] = 1;
       }},
  };
  return scenes;
}

// As .ply at path.
inline void write_hostile(const std::filesystem::path& path, const HostileScene& hostile,
                          std::size_t gaussians) {
  constexpr unsigned kSeed = 7;
  Scene scene;
  scene.cloud = random_cloud(hostile.alone ? 1 : gaussians, kSeed);
  for (glm::vec3& position : scene.cloud.position) position *= 2.5f;
  hostile.make(scene.cloud);
  scene.file_rows = scene.cloud.size();
  scene.format = SceneFormat::kSplat;  // not .ply: rows are written, not copied
  save_scene(path, scene, {}, SceneFormat::kPly);
}

}  // namespace splatcut::testing
