// How photographs show a point, by hand; close-ups, and the same click from near and from where photographs
// stand.
#include "segment/superpoints/photographed.h"

#include <doctest/doctest.h>

#include <vector>

using namespace splatcut;

namespace {

Camera widened(const Camera& camera, std::span<const Camera> photographs, const glm::vec3& point_world) {
  return with_margins(camera, margins_of_close_up(camera, photographs, point_world));
}

constexpr glm::vec3 kPoint{0, 0, 0};

// 100 x 100 pixels, as wide as it is far.
Camera photograph(float distance) {
  Camera camera = look_at({0, 0, -distance}, kPoint, {0, 1, 0}, 0.5f, 100, 100);
  camera.fx_px = camera.fy_px = 100;
  return camera;
}

}  // namespace

TEST_CASE("photographs: medians of those that show a point, and nothing of two") {
  std::vector<Camera> cameras = {photograph(4), photograph(1), photograph(2), photograph(8)};
  const auto all = photographed(cameras, kPoint);
  REQUIRE(all);
  CHECK(all->distance == doctest::Approx(2));  // the lower one of two
  CHECK(all->breadth == doctest::Approx(2));
  cameras[1].width_px = 400;  // of 400 x 100 pixels a square has 200
  CHECK(photographed(std::span(cameras).first(3), kPoint)->breadth == doctest::Approx(2));
  cameras[0] = look_at({0, 0, -4}, {0, 0, -9}, {0, 1, 0}, 0.5f, 100, 100);  // turned away
  CHECK_FALSE(cameras[0].shows(kPoint));
  CHECK(photographed(cameras, kPoint)->distance == doctest::Approx(2));
  CHECK_FALSE(photographed(std::span(cameras).first(3), kPoint));
  CHECK_FALSE(photographed({}, kPoint));
}

TEST_CASE("photographs: a close-up shows less than two thirds of what they show, and is widened to it") {
  const std::vector<Camera> cameras(3, photograph(3));
  const glm::vec3 beside{0.6f, -0.4f, 0.2f};
  for (const float distance : {6.0f, 3.0f, 2.01f}) {
    CHECK_FALSE(is_close_up(photograph(distance), cameras, kPoint));
    CHECK(same_camera(widened(photograph(distance), cameras, kPoint), photograph(distance)));
  }
  for (const float distance : {1.9f, 1.5f, 1.0f}) {
    const Camera near = photograph(distance);
    CHECK(is_close_up(near, cameras, kPoint));
    const Camera wide = widened(near, cameras, kPoint);
    CHECK(same_pose(wide, near));
    CHECK(wide.width_px == doctest::Approx(100 * 3 / distance).epsilon(0.02));
    CHECK_FALSE(is_close_up(wide, cameras, kPoint));
    // It is the same picture with a margin all around.
    const float margin_px = static_cast<float>(wide.width_px - 100) / 2;
    const glm::vec2 in_near = near.pixel_from_camera(near.camera_from_world(beside));
    const glm::vec2 in_wide = wide.pixel_from_camera(wide.camera_from_world(beside));
    CHECK(in_wide.x == doctest::Approx(in_near.x + margin_px));
    CHECK(in_wide.y == doctest::Approx(in_near.y + margin_px));
  }
  CHECK(widened(photograph(0.01f), cameras, kPoint).width_px == 300);
  CHECK_FALSE(is_close_up(photograph(0.01f), std::span(cameras).first(2), kPoint));
  CHECK(same_camera(widened(photograph(0.01f), {}, kPoint), photograph(0.01f)));
}
