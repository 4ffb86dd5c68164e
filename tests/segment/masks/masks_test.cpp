// Masks settled by pixels and carried between views, trajectories, disturbances: by hand, by geometry, by
// brute force.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <set>

#include "app/measure/mask_disturbance.h"
#include "app/measure/robot_user.h"
#include "core/error.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/colour_overlap.h"
#include "segment/masks/mask_tools.h"
#include "segment/masks/propagate.h"
#include "segment/masks/refine_mask.h"
#include "segment/session/doubts.h"
#include "segment/superpoints/orbit.h"
#include "still_life_mug.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

Mask disc(int width, int height, float cx, float cy, float radius) {
  Mask mask(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      mask.at(x, y) = std::hypot(x + 0.5 - cx, y + 0.5 - cy) <= radius ? kMaskObject : 0;
  return mask;
}

// The mask in red over grey, both with noise.
Image<Rgb8> painted(const Mask& mask, unsigned seed) {
  std::mt19937 random(seed);
  Image<Rgb8> picture(mask.width(), mask.height());
  const auto byte = [&](int middle) {
    return static_cast<std::uint8_t>(middle + static_cast<int>(random() % 31) - 15);
  };
  for (std::size_t i = 0; i < mask.size(); ++i)
    picture.pixels()[i] =
        mask.pixels()[i] ? Rgb8{byte(190), byte(60), byte(50)} : Rgb8{byte(110), byte(120), byte(125)};
  return picture;
}

// What a view of the mug scene shows, with the true mask.
SeenView look(const MugScene& scene, const Camera& camera) {
  RasterOptions options;
  options.depth = true;
  const RasterOutput out = rasterize(scene.cloud, camera, options);
  return {camera, rgb8_from_linear(out.colour), out.expected_depth,
          thresholded(render_labels(scene.cloud, camera, scene.mug), 0.5f)};
}

}  // namespace

TEST_CASE("overlap of colours: the lesser shares, by hand") {
  const Rgb8 red{200, 30, 30}, blue{30, 30, 200}, grey{120, 120, 120};
  // Two red columns and two of the mask's others, then grey ones beside it.
  const auto overlap = [&](const Rgb8& third, const Rgb8& fifth, float right_px) {
    const std::array<Rgb8, 8> columns{red, red, third, third, fifth, grey, grey, grey};
    Image<Rgb8> picture(8, 4);
    Mask mask(8, 4);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x) {
        picture.at(x, y) = columns[static_cast<std::size_t>(x)];
        mask.at(x, y) = x < 4 ? kMaskObject : 0;
      }
    return overlap_of_colours(colour_bins(picture), mask, {{0, 0}, {right_px, 4}});
  };
  CHECK(overlap(blue, grey, 8) == 0);
  CHECK(overlap(grey, grey, 8) == doctest::Approx(0.5));  // half of the mask is grey, all beside it is
  CHECK(overlap(blue, red, 8) == doctest::Approx(0.25));  // half of the mask is red, a quarter beside it is
  CHECK(overlap(blue, red, 5) == doctest::Approx(0.5));   // all of what is looked at beside it is
  CHECK(overlap(blue, grey, 4) == 1);                     // nothing stands beside it
}

TEST_CASE("connected region: across sides, not across corners, and the pixel itself") {
  const std::array<std::string_view, 4> rows{"##..#", ".#..#", "..##.", "#.##."};
  Mask mask(5, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      mask.at(x, y) = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#' ? kMaskObject : 0;
  CHECK(count(connected_to(mask, {0, 0})) == 3);
  CHECK(count(connected_to(mask, {3, 3})) == 4);
  CHECK(count(connected_to(mask, {0, 3})) == 1);
  CHECK(count(connected_to(mask, {2, 1})) == 8);  // joins two of them
  CHECK(connected_to(mask, {4, 0}).at(4, 1) == kMaskObject);
}

TEST_CASE("ratio of colours: by hand") {
  const Rgb8 red{200, 30, 30}, blue{30, 30, 200};
  Image<Rgb8> picture(4, 1, red);
  picture.at(2, 0) = picture.at(3, 0) = blue;
  const auto mask = [](std::initializer_list<int> columns) {
    Mask of(4, 1);
    for (const int x : columns) of.at(x, 0) = kMaskObject;
    return of;
  };
  // Half of the one side is red, a whole of the other.
  CHECK(log_ratio_of_colours(picture, mask({0}), mask({1, 2}), mask({0, 1})) ==
        doctest::Approx(std::log(0.501 / 1.001)));
  CHECK(log_ratio_of_colours(picture, mask({0}), mask({1}), mask({2})) == doctest::Approx(std::log(1001)));
  CHECK(log_ratio_of_colours(picture, mask({0, 2}), mask({0, 1}), mask({2, 3})) == doctest::Approx(0));
  CHECK(log_ratio_of_colours(picture, mask({}), mask({0}), mask({2})) == 0);
}

TEST_CASE("orbit: from straight above or below, and from within, the ring looks at the object") {
  for (const glm::vec3& from : {glm::vec3(0, -3, 0), glm::vec3(0, 3, 0), glm::vec3(0)}) {
    CAPTURE(from.y);
    const Camera above = look_at(from, from + glm::vec3(0, from.y > 0 ? -1 : 1, 0), {0, 0, 1}, 0.9f, 64, 48);
    const std::vector<Camera> ring = orbit_cameras(above, {0, -1, 0}, {{0, 0, 0}, 0.5f}, {});
    REQUIRE(!ring.empty());
    for (const Camera& camera : ring)
      CHECK(glm::length(glm::cross(camera.forward_world(), camera.centre_world())) < 1e-4f);
  }
}

TEST_CASE(
    "masks: both solvers find a painted disc from a prior two pixels off, and keep what is outside of the "
    "band") {
  const Mask truth = disc(120, 90, 60, 45, 25);
  const Image<Rgb8> picture = painted(truth, 5);
  const Image<float> depth(120, 90, 1.0f);
  for (const float radius : {22.0f, 28.0f}) {
    const Mask prior = disc(120, 90, 60, 45, radius);
    for (const MaskSolver solver : {MaskSolver::kGrabCut, MaskSolver::kPixelCut}) {
      const Mask found = refine_mask(picture, depth, prior, {.solver = solver, .band_px = 5});
      CHECK(iou(found, truth) > 0.97);
      CHECK(iou(found, truth) > iou(prior, truth));
      const Mask kept = refine_mask(picture, depth, prior, {.solver = solver, .band_px = 1});
      const Mask core = eroded(prior, 1), reach = dilated(prior, 1);
      for (std::size_t i = 0; i < kept.size(); ++i) {
        if (core.pixels()[i]) CHECK(kept.pixels()[i]);
        if (!reach.pixels()[i]) CHECK_FALSE(kept.pixels()[i]);
      }
    }
    CHECK(refine_mask(picture, depth, prior, {.solver = MaskSolver::kNone}) == prior);
  }
  const Mask nothing(120, 90);
  CHECK(refine_mask(picture, depth, nothing, {.solver = MaskSolver::kPixelCut}) == nothing);
}

TEST_CASE("masks: the pixel cut follows a jump of depth where colours are equal, and obeys strokes") {
  const Mask truth = disc(100, 80, 50, 40, 20);
  const Image<Rgb8> grey(100, 80, Rgb8{120, 120, 120});
  Image<float> depth(100, 80, 2.0f);
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (truth.pixels()[i]) depth.pixels()[i] = 1;
  RefineOptions options{.solver = MaskSolver::kPixelCut, .band_px = 6};
  options.prior_weight = 0.2f;
  const Mask prior = disc(100, 80, 50, 40, 17);
  CHECK(iou(refine_mask(grey, depth, prior, options), truth) > 0.97);
  Image<std::uint8_t> seeds(100, 80, kNoSeed);
  seeds.at(50, 40) = kRestSeed;
  seeds.at(50, 61) = kObjectSeed;  // beyond the border, within the band
  const Mask obeys = refine_mask(grey, depth, prior, options, seeds);
  CHECK(obeys.at(50, 40) == 0);
  CHECK(obeys.at(50, 61) == kMaskObject);
}

TEST_CASE("masks: how wide a picture shows enough of what is small, by hand") {
  Mask mask(100, 80);
  CHECK(width_to_see(mask, 48, 1000) == 100);  // nothing is shown
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) mask.at(x, y) = kMaskObject;
  CHECK(width_to_see(mask, 20, 1000) == 100);
  CHECK(width_to_see(mask, 21, 1000) == 142);  // one step of sqrt(2)
  CHECK(width_to_see(mask, 28, 1000) == 142);
  CHECK(width_to_see(mask, 29, 1000) == 200);
  CHECK(width_to_see(mask, 160, 1000) == 800);
  CHECK(width_to_see(mask, 160, 500) == 500);
  CHECK(width_to_see(mask, 160, 100) == 100);
}

TEST_CASE("masks: a grown band reaches further outside, not further inside") {
  const Mask truth = disc(120, 90, 60, 45, 30), prior = disc(120, 90, 60, 45, 24);
  const Image<Rgb8> picture = painted(truth, 9);
  const Image<float> depth(120, 90, 1.0f);
  RefineOptions narrow{.solver = MaskSolver::kPixelCut, .band_px = 2}, wide = narrow;
  wide.grow_px = 6;
  CHECK(iou(refine_mask(picture, depth, prior, wide), truth) > 0.97);
  CHECK(iou(refine_mask(picture, depth, prior, narrow), truth) < 0.9);
}

TEST_CASE("masks: through depth and along flow into a view some degrees on, the true mask is nearly found") {
  const MugScene scene = still_life_with_mug(60000);
  const Camera first = limited_to_width(scene.cameras[0], 320);
  const SeenView from = look(scene, first);
  const ObjectExtent mug = object_extent(scene.cloud, scene.mug);
  OrbitOptions orbit;
  orbit.views = 60;  // six degrees
  orbit.elevation_swing_rad = 0;
  orbit.distance_sizes = glm::distance(first.centre_world(), mug.centre_world) / (2 * mug.radius);
  const std::vector<Camera> around = orbit_cameras(first, {0, -1, 0}, mug, orbit);
  const SeenView aimed =
      look(scene, look_at(first.centre_world(), mug.centre_world, {0, -1, 0}, 0.8f, 320, 240));
  const SeenView to = look(scene, limited_to_width(around[0], 320));
  REQUIRE(count(to.mask) > 200);
  CHECK(iou(warped_by_depth(from, to.camera, to.depth), to.mask) > 0.85);
  Camera near = aimed.camera;
  near.camera_from_world_translation += glm::vec3(0.05f, 0, 0) * mug.radius;
  const SeenView beside = look(scene, near);
  const Mask warped = warped_by_flow(aimed, beside.picture);
  CHECK(iou(warped, beside.mask) > 0.9);
  tbb::task_arena(1).execute([&] { CHECK(warped_by_flow(aimed, beside.picture) == warped); });
  // Into itself: everything comes back but what its own depth cannot vouch for.
  CHECK(iou(warped_by_depth(from, first, from.depth), from.mask) > 0.999);
}

TEST_CASE(
    "trajectories: a circle of cameras is no front, cameras side by side are, the spiral stays within their "
    "angles") {
  std::vector<Camera> ring, row;
  for (int i = 0; i < 12; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / 12;
    ring.push_back(
        look_at({4 * std::cos(angle), -2, 4 * std::sin(angle)}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120));
    row.push_back(
        look_at({0.2f * static_cast<float>(i) - 1.1f, -0.3f, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120));
  }
  CHECK_FALSE(front_facing(ring));
  CHECK(front_facing(row));
  CHECK_FALSE(front_facing({}));
  const ObjectExtent object{{0, 0, 0}, 0.5f};
  OrbitOptions options;
  options.views = 10;
  const auto sideways = [](const Camera& c) {
    return std::abs(std::atan2(c.centre_world().x, -c.centre_world().z));
  };
  float widest = 0;
  for (const Camera& camera : row) widest = std::max(widest, sideways(camera));
  for (const Camera& camera : cameras_around(row[5], {0, -1, 0}, object, row, options)) {
    CHECK(sideways(camera) <= widest * 1.01f);
    CHECK(glm::length(camera.centre_world()) == doctest::Approx(1.6f));
    CHECK(glm::dot(camera.forward_world(), -glm::normalize(camera.centre_world())) == doctest::Approx(1));
  }
  // Around: the photographs' elevation, not the reference's.
  options.elevation_swing_rad = 0;
  const Camera low = look_at({0, 0, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120);
  for (const Camera& camera : cameras_around(low, {0, -1, 0}, object, ring, options))
    CHECK(std::asin(-camera.centre_world().y / glm::length(camera.centre_world())) ==
          doctest::Approx(std::atan(0.5f)).epsilon(0.01));
}

TEST_CASE("trajectories: an approached camera keeps its direction at its share of the distance") {
  const Camera camera = look_at({1, -2, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120);
  const Camera nearer = approached(camera, {0, 0, 0}, 0.5f);
  CHECK(glm::distance(nearer.centre_world(), glm::vec3(0.5f, -1, -2)) < 1e-5f);
  CHECK(nearer.forward_world() == camera.forward_world());
}

TEST_CASE(
    "the unsteady robot clicks the same region as the steady one, elsewhere, the same for the same draw") {
  const Mask truth = disc(120, 90, 60, 45, 25), nothing(120, 90);
  std::set<std::pair<float, float>> places;
  for (std::uint64_t draw = 1; draw <= 20; ++draw) {
    const auto click = robot_click(truth, nothing, draw);
    REQUIRE(click);
    const glm::vec2 p = click->points_px.front();
    CHECK(std::hypot(p.x - 60, p.y - 45) <= 13);  // at least half as deep as the middle
    CHECK(robot_click(truth, nothing, draw)->points_px.front() == p);
    places.insert({p.x, p.y});
  }
  CHECK(places.size() > 15);
  CHECK(robot_click(truth, nothing, 0)->points_px == robot_click(truth, nothing)->points_px);
}

TEST_CASE("disturbed masks: shifted, emptied, filled, an unknown kind is refused") {
  const Mask mask = disc(120, 90, 50, 45, 20);
  const Mask right = disturbed(mask, {"shift", 7});
  for (int y = 0; y < 90; ++y)
    for (int x = 7; x < 120; ++x) CHECK(right.at(x, y) == mask.at(x - 7, y));
  CHECK(count(disturbed(mask, {"empty", 1})) == 0);
  CHECK(count(disturbed(mask, {"full", 1})) == mask.size());
  CHECK(disturbed(mask, {"none", 9}) == mask);
  CHECK_THROWS_AS(disturbed(mask, {"melt", 1}), Error);
}

TEST_CASE("doubts: another size, masks left out, and a cutout that most masks speak against, in words") {
  CutResult report;
  report.views.resize(4);
  for (ViewReport& view : report.views) {
    view.used = true;
    view.confidence = 0.95;
  }
  CHECK(doubts(report).empty());
  report.certainty = 0.84;
  CHECK(doubts(report) ==
        std::vector<std::string>{"what was said first could mean a smaller or a larger part"});
  report.meanings.resize(3);
  CHECK(doubts(report) ==
        std::vector<std::string>{"what was said first could mean one of 3 things: this is 1"});
  report.certainty = 0.86;
  report.views[1].used = false;
  report.views[1].reason = "the object is hidden here";
  CHECK(doubts(report).empty());
  report.views[1].disagreed = true;
  CHECK(doubts(report) ==
        std::vector<std::string>{"1 of 4 masks were left out, they disagree with the others"});
  report.views[1].disagreed = false;
  report.views[2].confidence = report.views[3].confidence = 0.1;
  CHECK(doubts(report) ==
        std::vector<std::string>{
            "2 of 3 masks disagree with the cutout: it is not to be trusted, look at the masks"});

  Mask& first = report.views.front().mask;
  const auto of_first = [&](int x0, int y0, int x1, int y1) {
    first = Mask(200, 100);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) first.at(x, y) = kMaskObject;
    return doubts_of_views(std::span(report.views).first(1));
  };
  CHECK(of_first(80, 40, 97, 57).empty());
  CHECK(of_first(80, 40, 92, 52) ==
        std::vector<std::string>{"the object is small in the first view, 6 % of its width: come nearer"});
  // Said until a click was made from near enough, in a view that counts.
  std::vector<ViewReport> views(2, report.views.front());
  Mask near(200, 100);
  const auto said = [&] { return doubts_of_views(views).size(); };
  CHECK(said() == 1);
  for (int y = 40; y < 60; ++y)
    for (int x = 80; x < 100; ++x) near.at(x, y) = kMaskObject;
  views[1].mask = near;
  CHECK(said() == 1);  // nobody clicked there
  views[1].clicked = true;
  CHECK(said() == 0);
  views[1].used = false;
  CHECK(said() == 1);
  views[1] = views[0];
  views[1].clicked = true;  // as far
  CHECK(said() == 1);
  CHECK(of_first(0, 0, 40, 20).empty());  // a corner: 60 of 596 pixels of the frame
  CHECK(of_first(0, 0, 200, 20) == std::vector<std::string>{kRunsOut});
  // Said until a click was made in a view that shows all of it, and that counts.
  views.assign(2, report.views.front());
  views[1].clicked = true;
  CHECK(said() == 1);  // it crops the object, too
  views[1].mask = near;
  CHECK(said() == 0);
  views[1].used = false;
  CHECK(said() == 1);
}
