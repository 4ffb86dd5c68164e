// Rings: ellipses known by hand, who is drawn, how many.
#include "app/picture/splat_rings.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "scene/raster/splat_math.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

const PictureDepth kNoPicture(nullptr, 0);

std::vector<Ring> rings_of(const GaussianCloud& cloud, const Camera& camera, const RingOptions& options = {},
                           const Flags& shown = nullptr, const Flags& of_object = nullptr) {
  SplatRings rings;
  rings.begin(std::make_shared<const GaussianCloud>(cloud), shown, of_object);
  return rings.in_view(camera, kNoPicture, options);
}

std::vector<std::uint32_t> who(const std::vector<Ring>& rings) {
  std::vector<std::uint32_t> out;
  for (const Ring& r : rings) out.push_back(r.gaussian);
  return out;
}

}  // namespace

TEST_CASE("rings: the half axes of a turned splat are two of its deviations in pixels") {
  GaussianCloud cloud = single_splat(2, 0.1f, 0.9f, glm::vec3(0.5f));
  Camera camera = axis_camera();
  cloud.scale[0] = {0.4f, 0.1f, 0.01f};
  const float angle = glm::radians(30.0f);
  cloud.rotation[0] = glm::angleAxis(angle, glm::vec3(0, 0, 1));
  const std::vector<Ring> rings = rings_of(cloud, camera);
  REQUIRE(rings.size() == 1);
  const auto half_axis = [&](float sigma) {
    const float px = camera.fx_px * sigma / 2;
    return 2 * std::sqrt(px * px + kLowPassPx2);
  };
  CHECK(glm::length(rings[0].long_px) == doctest::Approx(half_axis(0.4f)).epsilon(1e-3));
  CHECK(glm::length(rings[0].short_px) == doctest::Approx(half_axis(0.1f)).epsilon(1e-3));
  const glm::vec2 along = glm::normalize(rings[0].long_px), expected(std::cos(angle), std::sin(angle));
  CHECK(std::abs(glm::dot(along, expected)) == doctest::Approx(1).epsilon(1e-4));
  CHECK(rings[0].centre_px.x == doctest::Approx(camera.cx_px));
  CHECK(rings[0].centre_px.y == doctest::Approx(camera.cy_px));
}

TEST_CASE("rings: none before the near plane, beyond the far one, beside the picture, or of a dot") {
  const Camera camera = axis_camera();
  const GaussianCloud splat = single_splat(2, 0.1f, 0.9f, glm::vec3(0.5f));
  RingOptions options{.least_radius_px = 0.5f};
  CHECK(rings_of(splat, camera, options).size() == 1);
  options.limits.near_plane = 2.1f;
  CHECK(rings_of(splat, camera, options).empty());
  options.limits = {.near_plane = 0.1f, .far_plane = 1.9f};
  CHECK(rings_of(splat, camera, options).empty());
  CHECK(rings_of(splat, camera, {.least_radius_px = 100}).empty());
  GaussianCloud beside = splat;
  beside.position[0].x = 50;
  CHECK(rings_of(beside, camera, {.least_radius_px = 0.5f}).empty());
  beside.position[0] = {0, 0, -2};
  CHECK(rings_of(beside, camera, {.least_radius_px = 0.5f}).empty());
}

TEST_CASE("rings: of those that are shown and of the object alone") {
  const GaussianCloud cloud = random_cloud(3000, 11, 0);
  const Camera camera = front_camera();
  const RingOptions options{.least_radius_px = 0.5f, .most = 100000, .most_tried = 1000000};
  const std::vector<std::uint32_t> all = who(rings_of(cloud, camera, options));
  REQUIRE(all.size() > 500);
  std::vector<std::uint8_t> shown(cloud.size()), object(cloud.size());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    shown[g] = g % 2 == 0;
    object[g] = g % 3 == 0;
  }
  std::vector<std::uint32_t> expected;
  for (const std::uint32_t g : all)
    if (shown[g] && object[g]) expected.push_back(g);
  CHECK(who(rings_of(cloud, camera, options, make_flags(shown), make_flags(object))) == expected);
}

TEST_CASE("rings: as many as asked, evenly, and fewer are a part of more") {
  const GaussianCloud cloud = random_cloud(20000, 12, 0);
  const Camera camera = front_camera();
  RingOptions options{.least_radius_px = 0.5f, .most = 100000, .most_tried = 1000000};
  const std::size_t all = rings_of(cloud, camera, options).size();
  REQUIRE(all > 4000);
  options.most = 2000;
  const std::vector<std::uint32_t> many = who(rings_of(cloud, camera, options));
  CHECK(many.size() == 2000);
  options.most = 500;
  const std::vector<std::uint32_t> few = who(rings_of(cloud, camera, options));
  CHECK(few.size() == 500);
  CHECK(std::ranges::includes(many, few));
  // Each quarter of the file, a region of space, keeps about its share.
  for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
    const auto within = [&](std::uint32_t g) { return g / 5000 == quarter; };
    options.most = 100000;
    const auto whole =
        static_cast<double>(std::ranges::count_if(who(rings_of(cloud, camera, options)), within));
    const auto kept = static_cast<double>(std::ranges::count_if(many, within));
    CHECK(kept / 2000 == doctest::Approx(whole / static_cast<double>(all)).epsilon(0.15));
  }
  // A budget of what is looked at is kept, too.
  options.most_tried = 1000;
  const std::size_t tried = rings_of(cloud, camera, options).size();
  CHECK(tried > 0);
  CHECK(tried <= 1100);
}

TEST_CASE("rings: what the picture hides has none, as long as the picture knows the place") {
  GaussianCloud cloud = single_splat(2, 0.3f, 0.99f, glm::vec3(0.5f));
  const GaussianCloud behind = single_splat(4, 0.1f, 0.99f, glm::vec3(0.5f));
  cloud.resize(2, 0);
  cloud.position[1] = behind.position[0];
  cloud.scale[0] = {0.3f, 0.3f, 0.01f};
  cloud.scale[1] = behind.scale[0];
  cloud.rotation[1] = behind.rotation[0];
  cloud.opacity[1] = behind.opacity[0];
  const Camera camera = axis_camera();
  FrameResult picture;
  picture.frames.push_back(raster_frame(cloud, camera, nullptr, {}));
  SplatRings rings;
  rings.begin(std::make_shared<const GaussianCloud>(cloud), nullptr, nullptr);
  const RingOptions options{.least_radius_px = 0.5f};
  CHECK(who(rings.in_view(camera, {&picture, 0}, options)) == std::vector<std::uint32_t>{0});
  CHECK(rings.in_view(camera, kNoPicture, options).size() == 2);
  CHECK(rings.in_view(camera, {&picture, 1}, options).size() == 2);  // another pane
}
