#include "bench_scenes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/cloud/morton.h"
#include "scene/formats/scene_file.h"
#include "still_life_mug.h"
#include "synthetic_cloud.h"

namespace splatcut::bench {

namespace {

constexpr int kWidth = 1280, kHeight = 720;

BenchScene make_still_life_scene(std::size_t gaussians) {
  testing::MugScene made = testing::still_life_with_mug(gaussians);
  BenchScene scene{
      std::move(made.cloud), resized(made.cameras.front(), kWidth, kHeight), {}, std::move(made.mug)};
  for (const Camera& camera : made.cameras) scene.cameras.push_back(limited_to_width(camera, 400));
  return scene;
}

BenchScene make_volume(std::size_t gaussians) {
  // Splats shrink as their number grows, as in a trained scene: the same things, described more finely.
  const float size = 0.05f * std::pow(1e5f / static_cast<float>(gaussians), 0.45f);
  const GaussianCloud cloud = testing::random_cloud(gaussians, 1, 1, size);
  return {permuted(cloud, morton_order(cloud.position)), testing::front_camera(kWidth, kHeight), {}, {}};
}

BenchScene load(const std::filesystem::path& path) {
  constexpr float kFovY = 0.87f;
  BenchScene scene{load_scene(path).cloud, {}, {}, {}};
  const Box box = robust_bounds(scene.cloud.position, 0.5);
  const float distance = 0.5f * glm::length(box.extent()) / std::sin(0.5f * kFovY);
  scene.view = look_at(box.centre() - glm::vec3(0, 0.35f, 0.94f) * distance, box.centre(), {0, -1, 0}, kFovY,
                       kWidth, kHeight);
  return scene;
}

}  // namespace

const BenchScene& still_life(std::size_t gaussians) {
  static std::map<std::size_t, BenchScene> scenes;
  const auto it = scenes.find(gaussians);
  return it != scenes.end() ? it->second : scenes[gaussians] = make_still_life_scene(gaussians);
}

const BenchScene& volume(std::size_t gaussians) {
  static std::map<std::size_t, BenchScene> scenes;
  const auto it = scenes.find(gaussians);
  return it != scenes.end() ? it->second : scenes[gaussians] = make_volume(gaussians);
}

const BenchScene& scene_from_file(const std::filesystem::path& path) {
  static std::map<std::filesystem::path, BenchScene> scenes;
  const auto it = scenes.find(path);
  return it != scenes.end() ? it->second : scenes[path] = load(path);
}

}  // namespace splatcut::bench
