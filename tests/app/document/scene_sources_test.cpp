// Places of files in the scene: the angles that a turn is written as.
#include <doctest/doctest.h>

#include <cmath>

#include "app/document/scene_sources.h"

using namespace splatcut;

namespace {

glm::quat turn_of(const ScenePlace& place) {
  SceneSource file;
  file.place = place;
  return similarity_of(file).rotation;
}

float degrees_between(const glm::quat& a, const glm::quat& b) {
  const glm::dquat apart = glm::conjugate(glm::dquat(a)) * glm::dquat(b);
  return static_cast<float>(
      glm::degrees(2 * std::atan2(glm::length(glm::dvec3(apart.x, apart.y, apart.z)), std::abs(apart.w))));
}

// The place after a turn by handles.
ScenePlace turned(const ScenePlace& place, const glm::quat& by) {
  PlacingChange change;
  change.turn = by;
  change.angle_rad = 1;
  return changed({}, place, change, {0, 1, 0});
}

}  // namespace

TEST_CASE(
    "scene sources: angles say the turn that they were made of, also where a file is turned by 90 about y") {
  constexpr float kSameDegrees = 1e-3f;
  const glm::quat none(1, 0, 0, 0), about_y = glm::angleAxis(glm::radians(15.0f), glm::vec3(0, 1, 0));
  for (int x = -180; x <= 180; x += 15)
    for (int y = -180; y <= 180; y += 15)
      for (int z = -180; z <= 180; z += 15) {
        const ScenePlace place{.turn_deg = {x, y, z}};
        const ScenePlace same = turned(place, none), other = turned(place, about_y);
        INFO(x, " ", y, " ", z);
        REQUIRE(degrees_between(turn_of(same), turn_of(place)) < kSameDegrees);
        REQUIRE(degrees_between(turn_of(other), about_y * turn_of(place)) < kSameDegrees);
        const bool plain = std::abs(y) < 90 && std::abs(x) < 180 && std::abs(z) < 180;
        if (plain) REQUIRE(glm::length(same.turn_deg - place.turn_deg) < 3 * kSameDegrees);
      }
  for (const float y : {90.0f, -90.0f, 89.9f, -89.99f, 89.9999f, 90.003f})  // typed
    for (const float x : {0.0f, 33.3f, -120.5f}) {
      const ScenePlace place{.turn_deg = {x, y, 12.25f}};
      INFO(x, " ", y);
      CHECK(degrees_between(turn_of(turned(place, none)), turn_of(place)) < kSameDegrees);
    }
  CHECK(turned({.turn_deg = {0, 90, 0}}, none).turn_deg.z == 0);  // no numbers that say nothing
}
