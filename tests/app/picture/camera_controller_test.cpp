// The camera keeps what it looks at beyond the near plane of pictures.
#include "app/picture/camera_controller.h"

#include <doctest/doctest.h>

#include <algorithm>
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
    camera.frame(
        camera.framing(corners, camera.camera(400, 300), 0, camera.rotation_along(glm::vec3(0, 1, 0))));
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
