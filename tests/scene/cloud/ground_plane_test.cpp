#include "scene/cloud/ground_plane.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/counter_rng.h"
#include "places.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/guessed_up.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void add(GaussianCloud* cloud, const glm::vec3& place, float opacity = 0.9f) {
  cloud->position.push_back(place);
  cloud->opacity.push_back(opacity);
}

// A floor at y = 0, a ball above it and a wall beside it; y points down.
GaussianCloud floor_and_ball(std::size_t on_floor, std::size_t in_ball, std::size_t on_wall) {
  CounterRng rng(3, 0);
  GaussianCloud cloud;
  for (std::size_t i = 0; i < on_floor; ++i)
    add(&cloud, {rng.between(-1, 1), rng.between(-0.002f, 0.002f), rng.between(-1, 1)});
  for (std::size_t i = 0; i < in_ball; ++i) add(&cloud, 0.5f * rng.in_ball() + glm::vec3(0, -0.5f, 0));
  for (std::size_t i = 0; i < on_wall; ++i) add(&cloud, {-1, rng.between(-2, 0), rng.between(-1, 1)});
  return cloud;
}

float degrees_between(const glm::vec3& a, const glm::vec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0f, 1.0f)));
}

glm::quat leaning(float by_deg, std::uint64_t stream) {
  CounterRng rng(5, stream);
  return glm::angleAxis(glm::radians(by_deg),
                        glm::normalize(glm::cross(glm::vec3(0, -1, 0), glm::normalize(rng.in_ball()))));
}

}  // namespace

TEST_CASE("ground plane: the floor below a ball, however it leans, not the larger wall beside it") {
  const GaussianCloud level = floor_and_ball(1000, 2000, 1500);
  for (const float by_deg : {0.0f, 15.0f, 30.0f, 40.0f})
    for (std::uint64_t stream = 0; stream < 4; ++stream) {
      const glm::quat turn = leaning(by_deg, stream);
      GaussianCloud cloud = level;
      for (glm::vec3& p : cloud.position) p = turn * p;
      const auto normal = ground_normal(cloud, {0, -1, 0});
      REQUIRE(normal);
      CHECK(degrees_between(*normal, turn * glm::vec3(0, -1, 0)) < 0.5f);
    }
}

TEST_CASE("ground plane: none without a floor, with a small one, with one that lies above or is not solid") {
  const glm::vec3 up(0, -1, 0);
  CHECK_FALSE(ground_normal({}, up));
  CHECK_FALSE(ground_normal(floor_and_ball(0, 3000, 0), up));
  CHECK_FALSE(ground_normal(floor_and_ball(150, 3000, 0), up));
  CHECK_FALSE(ground_normal(floor_and_ball(100, 0, 0), up));
  CHECK_FALSE(ground_normal(floor_and_ball(1000, 2000, 0), -up));
  GaussianCloud haze = floor_and_ball(1000, 2000, 0);
  for (std::size_t i = 0; i < 1000; ++i) haze.opacity[i] = 0.2f;
  CHECK_FALSE(ground_normal(haze, up));
}

TEST_CASE("ground plane: a table that leans is level again in the guess, one that is level stays exact") {
  const Scene scene = load_scene(project_folder() + "/assets/sample/sample.compressed.ply");
  const glm::vec3 up = guessed_up(scene.cloud);
  CHECK(up == glm::vec3(0, -1, 0));
  for (const float by_deg : {8.0f, 25.0f, 40.0f}) {
    const glm::quat turn = leaning(by_deg, 1);
    GaussianCloud cloud = scene.cloud;
    for (glm::vec3& p : cloud.position) p = turn * p;
    for (glm::quat& q : cloud.rotation) q = turn * q;
    CHECK(degrees_between(guessed_up(cloud), turn * up) < 1);
  }
}
