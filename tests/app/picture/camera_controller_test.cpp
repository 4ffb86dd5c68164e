// The camera keeps what it looks at beyond the near plane of pictures.
#include "app/picture/camera_controller.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

using namespace splatcut;

namespace {

constexpr float kNear = 0.5f;

// In the midst of a scene of 100 units.
CameraController in_a_park() {
  CameraController camera;
  camera.reset({{-50, -50, -50}, {50, 50, 50}}, {0, 0, 1});
  camera.set_near_plane(kNear);
  return camera;
}

float depth_of(const CameraController& camera, const glm::vec3& point_world) {
  return camera.camera(400, 300).camera_from_world(point_world).z;
}

}  // namespace

TEST_CASE("camera: what is framed lies beyond the near plane, however small it is") {
  for (const float size : {0.02f, 0.2f, 2.0f, 20.0f}) {
    CAPTURE(size);
    CameraController camera = in_a_park();
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(glm::vec3(3, 4, 5) + size * glm::vec3(i & 1, i >> 1 & 1, i >> 2));
    camera.frame(camera.framing(corners, camera.camera(400, 300), camera.rotation_along(glm::vec3(0, 1, 0))));
    camera.finish_transition();
    std::vector<float> depth;
    for (const glm::vec3& corner : corners) depth.push_back(depth_of(camera, corner));
    CHECK(std::ranges::min(depth) > kNear);
    CHECK(std::ranges::max(depth) < kNear + 4 * size);
  }
}

TEST_CASE("camera: the wheel and coming nearer end before the near plane hides what is looked at") {
  const glm::vec3 thing(3, 4, 5);
  CameraController camera = in_a_park();
  for (int i = 0; i < 200; ++i) camera.zoom(1, thing);
  CHECK(depth_of(camera, thing) > kNear);
  CHECK(depth_of(camera, thing) < 2 * kNear);
  camera.approach(thing, 0.01f);
  camera.finish_transition();
  CHECK(depth_of(camera, thing) > kNear);
  camera.set_near_plane(2);  // a place that is too near already stays where it is
  const float before = depth_of(camera, thing);
  camera.zoom(1, thing);
  CHECK(depth_of(camera, thing) == doctest::Approx(before));
}

TEST_CASE("camera: a picture taken on its side, or upside down, opens upright and shows as much") {
  const Camera level = look_at({3, -20, 4}, {0, 0, 1}, {0, 0, 1}, 0.5f, 400, 200);
  for (const int quarters : {0, 1, 2, 3}) {
    CAPTURE(quarters);
    Camera held = level;
    const float turn = glm::half_pi<float>() * static_cast<float>(quarters);
    held.camera_from_world_rotation =
        glm::mat3_cast(glm::angleAxis(turn, glm::vec3(0, 0, 1))) * level.camera_from_world_rotation;
    held.camera_from_world_translation =
        glm::mat3_cast(glm::angleAxis(turn, glm::vec3(0, 0, 1))) * level.camera_from_world_translation;
    CameraController camera;
    camera.reset({{-50, -50, -50}, {50, 50, 50}}, {0, 0, 1});
    camera.go_to_standing(held);
    camera.finish_transition();
    const Camera shown = camera.camera(400, 300);
    const glm::vec3 up = shown.camera_from_world_rotation * glm::vec3(0, 0, 1);
    CHECK(up.y < -0.9f);
    CHECK(std::abs(up.x) < 1e-4f);
    CHECK(glm::distance(shown.centre_world(), level.centre_world()) < 1e-3f);
    CHECK(glm::dot(shown.forward_world(), level.forward_world()) > 0.9999f);
    const float across = 2 * std::atan(std::tan(0.25f) * 2);  // of the picture's width
    CHECK(camera.pose().fov_y_rad == doctest::Approx(quarters % 2 == 1 ? across : 0.5f));
  }
}
