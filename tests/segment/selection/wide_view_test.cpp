// The wider picture in which a correcting click is looked at, by hand.
#include "segment/selection/wide_view.h"

#include <doctest/doctest.h>

#include <vector>

using namespace splatcut;

namespace {

// 160 x 80 pixels from 2 before the origin, 80 pixels a unit there: it shows x from -1 to 1.
Camera picture() {
  Camera camera;
  camera.width_px = 160;
  camera.height_px = 80;
  camera.fx_px = camera.fy_px = 160;
  camera.cx_px = 80;
  camera.cy_px = 40;
  camera.camera_from_world_translation = {0, 0, 2};
  return camera;
}

// A hundred Gaussians in a row, the labelled half of them from x0 to x1; and one stray.
GaussianCloud row(float x0, float x1) {
  GaussianCloud cloud;
  cloud.resize(101, 0);
  for (std::size_t i = 0; i < 100; ++i)
    cloud.position[i] = {x0 + (x1 - x0) * static_cast<float>(i) / 99, 0.1f, 0};
  cloud.position[100] = {50, 50, 0};
  return cloud;
}

Margins margins_of(const GaussianCloud& cloud, std::span<const Camera> photographs = {}) {
  return margins_of_correction(picture(), cloud, std::vector<std::uint8_t>(cloud.size(), 1),
                               {.photographs = {photographs.begin(), photographs.end()}, .subject = {}});
}

}  // namespace

TEST_CASE("corrections: a picture that holds the object is wide enough, whatever strays from it") {
  CHECK_FALSE(margins_of(row(-0.9f, 0.9f)).any());
  const GaussianCloud cloud = row(-3, 3);
  CHECK_FALSE(margins_of_correction(picture(), cloud, std::vector<std::uint8_t>(cloud.size(), 0), {}).any());
}

TEST_CASE("corrections: margins hold what the picture crops, on its side alone, in eighths up to its size") {
  // Up to x = 1.5 are 40 pixels beyond the right side, and a tenth of 160 more: 56 of 160, three eighths.
  const Margins right = margins_of(row(-0.5f, 1.52f));
  CHECK(right.right_px == 60);
  CHECK(right.left_px + right.top_px + right.bottom_px == 0);
  CHECK(margins_of(row(-9, 0)).left_px == 160);
  GaussianCloud behind = row(-9, 0);
  for (glm::vec3& p : behind.position) p.z = -3;  // of the camera
  CHECK_FALSE(margins_of(behind).any());
}

TEST_CASE("corrections: a close-up has margins all around, though it holds what is selected so far") {
  Camera photograph = picture();
  photograph.camera_from_world_translation = {0, 0, 4};
  const std::vector<Camera> photographs(3, photograph);
  const Margins margins = margins_of(row(-0.1f, 0.1f), photographs);
  for (const int beside_px : {margins.left_px, margins.right_px})
    CHECK(beside_px == doctest::Approx(80).epsilon(0.02));
  for (const int above_px : {margins.top_px, margins.bottom_px})
    CHECK(above_px == doctest::Approx(40).epsilon(0.03));
  CHECK_FALSE(margins_of(row(-0.1f, 0.1f), std::vector<Camera>(3, picture())).any());
}
