// How photographs, or pictures of the subject, show a point, by hand; close-ups and their margins.
#include "segment/superpoints/usual_picture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::vec3 kPoint{0, 0, 0};

Camera widened(const Camera& camera, const Capture& capture) {
  return with_margins(camera, margins_of_close_up(camera, usual_picture(camera, capture, kPoint)));
}

Capture captured(std::span<const Camera> photographs) {
  return {.photographs = {photographs.begin(), photographs.end()}, .subject = {}};
}

// 100 x 100 pixels, as wide as it is far.
Camera photograph(float distance) {
  Camera camera = look_at({0, 0, -distance}, kPoint, {0, 1, 0}, 0.5f, 100, 100);
  camera.fx_px = camera.fy_px = 100;
  return camera;
}

}  // namespace

TEST_CASE("usual picture: medians of the photographs that show a point, and nothing of two") {
  std::vector<Camera> cameras = {photograph(4), photograph(1), photograph(2), photograph(8)};
  const Camera any = photograph(5);
  const auto all = usual_picture(any, captured(cameras), kPoint);
  REQUIRE(all);
  CHECK(all->distance == doctest::Approx(2));  // the lower one of two
  CHECK(all->breadth == doctest::Approx(2));
  cameras[1].width_px = 400;  // of 400 x 100 pixels a square has 200
  const std::span<const Camera> three = std::span(cameras).first(3);
  CHECK(usual_picture(any, captured(three), kPoint)->breadth == doctest::Approx(2));
  cameras[0] = look_at({0, 0, -4}, {0, 0, -9}, {0, 1, 0}, 0.5f, 100, 100);  // turned away
  CHECK_FALSE(cameras[0].shows(kPoint));
  CHECK(usual_picture(any, captured(cameras), kPoint)->distance == doctest::Approx(2));
  CHECK_FALSE(usual_picture(any, captured(three), kPoint));
  CHECK_FALSE(usual_picture(any, kUnknownCapture, kPoint));
}

TEST_CASE("usual picture: a close-up shows less than two thirds of what photographs show, and is widened") {
  const Capture capture = captured(std::vector<Camera>(3, photograph(3)));
  const glm::vec3 beside{0.6f, -0.4f, 0.2f};
  for (const float distance : {6.0f, 3.0f, 2.01f}) {
    CHECK_FALSE(is_close_up(usual_picture(photograph(distance), capture, kPoint)));
    CHECK(same_camera(widened(photograph(distance), capture), photograph(distance)));
  }
  for (const float distance : {1.9f, 1.5f, 1.0f}) {
    const Camera near = photograph(distance);
    CHECK(is_close_up(usual_picture(near, capture, kPoint)));
    const Camera wide = widened(near, capture);
    CHECK(same_pose(wide, near));
    CHECK(wide.width_px == doctest::Approx(100 * 3 / distance).epsilon(0.02));
    CHECK_FALSE(is_close_up(usual_picture(wide, capture, kPoint)));
    // It is the same picture with a margin all around.
    const float margin_px = static_cast<float>(wide.width_px - 100) / 2;
    const glm::vec2 in_near = near.pixel_from_camera(near.camera_from_world(beside));
    const glm::vec2 in_wide = wide.pixel_from_camera(wide.camera_from_world(beside));
    CHECK(in_wide.x == doctest::Approx(in_near.x + margin_px));
    CHECK(in_wide.y == doctest::Approx(in_near.y + margin_px));
  }
  CHECK(widened(photograph(0.01f), capture).width_px == 300);
  const Capture two = captured(std::vector<Camera>(2, photograph(3)));
  CHECK_FALSE(is_close_up(usual_picture(photograph(0.01f), two, kPoint)));
  CHECK(same_camera(widened(photograph(0.01f), kUnknownCapture), photograph(0.01f)));
}

// Pictures of a subject of radius 1 are 2.3 broad: a picture is a close-up where it is less than two thirds
// of that, but no picture of the subject where it is less than 1 / 3.3 of it.
TEST_CASE("usual picture: without photographs, that of the subject, for what lies near it") {
  const Capture capture{.photographs = {}, .subject = {.centre_world = {0, 0, 1}, .radius = 1}};
  for (const float distance : {9.0f, 1.6f, 0.68f, 0.1f})
    CHECK_FALSE(is_close_up(usual_picture(photograph(distance), capture, kPoint)));
  for (const float distance : {1.5f, 1.0f, 0.72f}) {
    const auto usual = usual_picture(photograph(distance), capture, kPoint);
    REQUIRE(usual);
    CHECK(usual->breadth == doctest::Approx(2.3));
    CHECK(usual->distance == doctest::Approx(2.3));
    CHECK(is_close_up(usual_picture(photograph(distance), capture, kPoint)));
    CHECK(widened(photograph(distance), capture).width_px ==
          doctest::Approx(100 * std::min(3.0f, 2.3f / distance)).epsilon(0.02));
  }
  const Capture elsewhere{.photographs = {}, .subject = {.centre_world = {0, 0, 3.1f}, .radius = 1}};
  CHECK_FALSE(is_close_up(usual_picture(photograph(1), elsewhere, kPoint)));
}

TEST_CASE("usual picture: the subject is what was captured finely, and asked for without photographs alone") {
  // A cube of 2000 small splats about (4, 0, 0), and 2000 large ones all around.
  GaussianCloud cloud = random_cloud(4000, 7);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const bool thing = g % 2 == 0;
    cloud.opacity[g] = 0.9f;
    cloud.scale[g] = glm::vec3(thing ? 0.01f : 0.3f);
    cloud.position[g] = thing ? cloud.position[g] + glm::vec3(4, 0, 0) : 30.0f * cloud.position[g];
  }
  const Ball subject = capture_of(cloud, {}).subject;
  CHECK(glm::distance(subject.centre_world, {4, 0, 0}) < 0.1f);
  CHECK(subject.radius ==
        doctest::Approx(std::cbrt(3 / glm::pi<float>())).epsilon(0.05));  // half of the cube
  const Capture known = capture_of(cloud, std::vector<Camera>(1, photograph(1)));
  CHECK(known.subject.radius == 0);
  CHECK(known.photographs.size() == 1);
}
