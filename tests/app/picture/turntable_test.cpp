// Cameras of the object turning once: all of it is in every picture, as large as it can be.
#include "app/picture/turntable.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace splatcut;

TEST_CASE("turntable: the sphere around the object just fits, in narrow and wide views, upright and flat") {
  constexpr float kRadius = 0.7f;
  const ObjectExtent extent{{1, 2, 3}, kRadius};
  for (const float fov_y_rad : {0.1f, 0.5f, 1.0f, 2.0f})
    for (const auto& [width, height] : {std::pair(400, 300), std::pair(200, 500)}) {
      CAPTURE(fov_y_rad);
      const Camera front = look_at({1, 0, -2}, extent.centre_world, {0, -1, 0}, fov_y_rad, 640, 480);
      SaveTurntable command;
      command.frames = 5;
      command.width_px = width;
      command.height_px = height;
      for (const Camera& camera : cameras_of_turn(extent, front, {0, -1, 0}, command)) {
        const glm::vec3 middle = camera.camera_from_world(extent.centre_world);
        CHECK(glm::length(glm::vec2(middle)) < 1e-3f * middle.z);
        // Half the angle that the sphere is seen under, and that of the picture's smaller side.
        const float sphere = std::asin(kRadius / middle.z);
        const float side = std::atan(0.5f * static_cast<float>(std::min(width, height)) / camera.fy_px);
        CHECK(sphere < side);
        CHECK(std::sin(sphere) > 0.9f * std::sin(side));
      }
    }
}
