// The part of a scene that an object's own pictures can show: those pictures, of the part and of the scene.
#include "segment/finish/shown_part.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "segment/finish/own_views.h"
#include "segment/masks/mask_tools.h"
#include "thing_of_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The scene, and a copy of it so far away that no view shows it.
GaussianCloud with_another_far_away(const GaussianCloud& cloud) {
  std::vector<std::uint32_t> twice;
  for (std::uint32_t g = 0; g < cloud.size(); ++g) twice.insert(twice.end(), {g, g});
  GaussianCloud both = permuted(cloud, twice);
  for (std::size_t g = 1; g < both.size(); g += 2) both.position[g] += glm::vec3(0, 1000, 0);
  return both;
}

float largest_difference(const Image<glm::vec3>& a, const Image<glm::vec3>& b) {
  REQUIRE(a.size() == b.size());
  float most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.pixels()[i][c] - b.pixels()[i][c]));
  return most;
}

}  // namespace

TEST_CASE("shown part: the rows of labels of any number") {
  std::mt19937 random(1);
  for (std::size_t n = 0; n < 80; ++n) {
    std::vector<std::uint8_t> labels(n);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t g = 0; g < n; ++g) {
      labels[g] = random() % 8 == 0;
      if (labels[g]) expected.push_back(g);
    }
    CHECK(labelled_rows(labels) == expected);
  }
}

TEST_CASE("shown part: own pictures are those of the scene, whatever of the object's box is left out") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing thing(options, "orange");
  const GaussianCloud scene = with_another_far_away(thing.scene.cloud);
  std::vector<std::uint8_t> labels(scene.size(), 0);
  for (std::size_t g = 0; g < scene.size(); g += 2) labels[g] = thing.test.truth_labels[g / 2];
  const std::vector<Camera> cameras = own_cameras(scene, labels, {0, -1, 0}, thing.scene.cameras, {});
  const ShownPart part = shown_part(scene, labels, cameras, {});
  REQUIRE(part.row.size() == part.cloud.size());
  REQUIRE(part.labels.size() == part.cloud.size());
  CHECK(std::ranges::is_sorted(part.row));
  CHECK(part.row.size() < scene.size() / 2);
  CHECK(std::ranges::none_of(part.row, [](std::uint32_t g) { return g % 2 == 1; }));
  CHECK(std::ranges::count(part.labels, 1) == std::ranges::count(labels, 1));

  // Nothing is left out, then the object, then half of all that lies in its box, by chance.
  glm::vec3 low(1e30f), high(-1e30f);
  for (std::size_t g = 0; g < scene.size(); ++g)
    if (labels[g]) low = glm::min(low, scene.position[g]), high = glm::max(high, scene.position[g]);
  std::mt19937 random(11);
  std::vector<std::uint8_t> all(scene.size(), 1), without_object(all), without_half(all);
  for (std::size_t g = 0; g < scene.size(); ++g) {
    const glm::vec3& p = scene.position[g];
    const bool in_box = glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
    without_object[g] = labels[g] == 0;
    without_half[g] = !in_box || random() % 2 == 0;
  }
  for (const std::vector<std::uint8_t>& shown : {all, without_object, without_half}) {
    std::vector<std::uint8_t> shown_of_part;
    for (const std::uint32_t g : part.row) shown_of_part.push_back(shown[g]);
    for (const Camera& camera : cameras) {
      RasterOptions raster;
      raster.roi = grown(labelled_rectangle(scene, camera, labels), kSurroundingsPx, camera.width_px,
                         camera.height_px);
      raster.shown = shown;
      const Image<glm::vec3> whole = rasterize(scene, camera, raster).colour;
      raster.shown = shown_of_part;
      CHECK(largest_difference(rasterize(part.cloud, camera, raster).colour, whole) < 1e-3f);
    }
  }
}
