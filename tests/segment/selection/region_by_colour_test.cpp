// What a click on the rest means by colour: a stone on grass, of which no part of the hierarchy ends where
// the grass begins.
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "core/counter_rng.h"
#include "four_stripes.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/stroke_replay.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kWidth = 80, kHeight = 60;
constexpr int kStoneLeft = 10, kStoneRight = 50, kRimRight = 65, kTop = 8, kBottom = 52;

enum Stuff { kStone, kRim, kGrass };

Stuff stuff_at(int x, int y) {
  const bool row = y >= kTop && y < kBottom;
  if (row && x >= kStoneLeft && x < kStoneRight) return kStone;
  return row && x >= kStoneRight && x < kRimRight ? kRim : kGrass;
}

// A Gaussian per pixel. Leaf 0 is the stone, leaf 1 the grass; the rim beside the stone belongs to one of
// them.
PartHierarchy stone_with_rim(std::uint32_t leaf_of_rim = 0) {
  PartHierarchy parts;
  parts.leaves = 2;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Stuff stuff = stuff_at(x, y);
      parts.leaf_of.push_back(stuff == kRim ? leaf_of_rim : stuff == kGrass);
    }
  PartTree tree;
  tree.parent = {2, 2, kNoPart};
  const std::array<std::uint32_t, 2> leaf{kNoPart, kNoPart};
  tree.children = {leaf, leaf, {0, 1}};
  tree.area = {24, 24, 48};
  tree.cut = {0.001f, 1, 1};
  tree.merge_cost = {0, 0, 1};
  parts.trees = {tree};
  parts.plain_trees = 1;
  parts.leaf_area = {24, 24};
  parts.leaf_centre_world = {{0, 0, 0}, {0, 0, 0}};
  return parts;
}

constexpr Rgb8 kGrey{120, 120, 120}, kGreen{70, 130, 50};

// From 10 units before the plane of the stone, at 10 pixels a unit.
Camera before_the_stone() {
  Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, kWidth, kHeight);
  camera.fx_px = camera.fy_px = 100;
  return camera;
}

LeafView view_of(const PartHierarchy& parts, const Rgb8& rim) {
  const Camera camera = before_the_stone();
  Image<std::int32_t> hit(kWidth, kHeight);
  for (std::size_t i = 0; i < hit.size(); ++i) hit.pixels()[i] = static_cast<std::int32_t>(i);
  LeafView view = leaf_view_of_hits(parts, camera, hit);
  view.colour = Image<Rgb8>(kWidth, kHeight);
  CounterRng random(7, 0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Stuff stuff = stuff_at(x, y);
      Rgb8 colour = stuff == kStone ? kGrey : stuff == kRim ? rim : kGreen;
      for (std::uint8_t& channel : colour)
        channel = static_cast<std::uint8_t>(static_cast<float>(channel) + random.between(-12, 12));
      view.colour.at(x, y) = colour;
    }
  return view;
}

// The same as a scene: a flat Gaussian per pixel of that camera.
GaussianCloud cloud_of(const Rgb8& rim) {
  constexpr float kSh0 = 0.28209479f;
  GaussianCloud cloud;
  cloud.resize(static_cast<std::size_t>(kWidth * kHeight), 0);
  CounterRng random(7, 0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto g = static_cast<std::size_t>(y * kWidth + x);
      const Stuff stuff = stuff_at(x, y);
      const Rgb8 colour = stuff == kStone ? kGrey : stuff == kRim ? rim : kGreen;
      cloud.position[g] = {(static_cast<float>(x - kWidth / 2) + 0.5f) / 10,
                           (static_cast<float>(y - kHeight / 2) + 0.5f) / 10, 0};
      cloud.scale[g] = {0.05f, 0.05f, 0.001f};
      cloud.rotation[g] = {1, 0, 0, 0};
      cloud.opacity[g] = 0.99f;
      for (int channel = 0; channel < 3; ++channel) {
        const float shade = static_cast<float>(colour[static_cast<std::size_t>(channel)]) / 255;
        cloud.f_dc[g][channel] = (shade + random.between(-0.05f, 0.05f) - 0.5f) / kSh0;
      }
    }
  return cloud;
}

SelectionModel no_part_fits() {
  SelectionModel model = borders_alone();
  weight(&model.later, Term::kDisc) = -100;
  return model;
}

// The stone and its rim by one click.
ClickSelection taken(const PartHierarchy& parts, const LeafView& view) {
  ClickSelection selection(parts, no_part_fits());
  selection.apply(view, click({30, 30}, SeedLabel::kObject));
  return selection;
}

// Gaussians of some stuff that are object.
int object(const ClickSelection& selection, Stuff stuff) {
  int count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      count += stuff_at(x, y) == stuff && selection.labels()[static_cast<std::size_t>(y * kWidth + x)];
  return count;
}

constexpr int kAllOfStone = (kStoneRight - kStoneLeft) * (kBottom - kTop);
constexpr int kAllOfRim = (kRimRight - kStoneRight) * (kBottom - kTop);

}  // namespace

TEST_CASE("region by colour: a click on the rim of grass takes all of it, and nothing of the stone") {
  const PartHierarchy parts = stone_with_rim();
  const LeafView view = view_of(parts, kGreen);
  ClickSelection selection = taken(parts, view);
  REQUIRE(object(selection, kStone) == kAllOfStone);
  REQUIRE(object(selection, kRim) == kAllOfRim);
  REQUIRE(object(selection, kGrass) == 0);
  CHECK(selection.apply(view, click({57, 30}, SeedLabel::kRest)));
  CHECK(object(selection, kStone) > 0.97 * kAllOfStone);
  CHECK(object(selection, kRim) < 0.05 * kAllOfRim);
  CHECK_FALSE(selection.spot_alone());
}

TEST_CASE("region by colour: it belongs to the click's own size, and the spot alone is a smaller one") {
  const PartHierarchy parts = stone_with_rim();
  const LeafView view = view_of(parts, kGreen);
  ClickSelection own = taken(parts, view);
  CHECK(own.apply(view, click({57, 30}, SeedLabel::kRest)));
  REQUIRE(own.likeliest_size() == 1);
  CHECK(own.size() == 1);
  CHECK(count(own.size_masks()[1]) > 0.9 * kAllOfRim);
  CHECK(count(own.size_masks()[0]) < 0.2 * kAllOfRim);
  ClickSelection spot = taken(parts, view);
  CHECK(spot.apply(view, sized(click({57, 30}, SeedLabel::kRest), -1)));
  CHECK(spot.size() == 0);
  CHECK(object(spot, kRim) > 0.8 * kAllOfRim);
}

TEST_CASE("region by colour: replayed clicks draw the colour that they need") {
  const PartHierarchy parts = stone_with_rim();
  const GaussianCloud cloud = cloud_of(kGreen);
  const ReplayOptions options{.model = no_part_fits()};
  const std::vector<CameraStroke> strokes{{before_the_stone(), click({30, 30}, SeedLabel::kObject)},
                                          {before_the_stone(), click({57, 30}, SeedLabel::kRest)}};
  StrokeReplay replay(parts);
  CHECK(object(replay.replay(cloud, std::span(strokes).first(1), options), kRim) > 0.95 * kAllOfRim);
  const Labels all = replay.replay(cloud, strokes, options).labels();
  CHECK(object(replay.replay(cloud, strokes, options), kStone) > 0.95 * kAllOfStone);
  CHECK(object(replay.replay(cloud, strokes, options), kRim) < 0.1 * kAllOfRim);
  // Cancelled at any moment nothing stays that was answered without its colour.
  for (int moment = 0; moment < 60; ++moment) {
    CAPTURE(moment);
    StrokeReplay again(parts);
    again.replay(cloud, std::span(strokes).first(1), options);
    std::stop_source stop;
    std::jthread after_a_while([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(50 * moment));
      stop.request_stop();
    });
    again.replay(cloud, strokes, options, {.stop = stop.get_token(), .on_progress = {}});
    after_a_while.join();
    CHECK(again.replay(cloud, strokes, options).labels() == all);
  }
}

TEST_CASE("region by colour: a click on the object takes no wall that looks like the stone") {
  const PartHierarchy parts = stone_with_rim(1);
  const LeafView view = view_of(parts, kGrey);
  ClickSelection selection = taken(parts, view);
  REQUIRE(object(selection, kRim) == 0);
  CHECK(selection.apply(view, click({57, 30}, SeedLabel::kObject)));
  CHECK(object(selection, kStone) == kAllOfStone);
  CHECK(object(selection, kRim) > 0);
  CHECK(object(selection, kRim) < 0.2 * kAllOfRim);
}

TEST_CASE("region by colour: what looks like the stone stays, but for the click's own disc") {
  const PartHierarchy parts = stone_with_rim();
  for (const bool coloured : {true, false}) {
    CAPTURE(coloured);
    LeafView view = view_of(parts, coloured ? kGrey : kGreen);
    if (!coloured) view.colour = {};
    ClickSelection selection = taken(parts, view);
    selection.apply(view, click({57, 30}, SeedLabel::kRest));
    CHECK(object(selection, kStone) == kAllOfStone);
    CHECK(object(selection, kRim) > 0.8 * kAllOfRim);
    CHECK(object(selection, kRim) < kAllOfRim);
    CHECK(selection.spot_alone());
  }
}

TEST_CASE("region by colour: a click at the border mends the border alone") {
  const PartHierarchy parts = stone_with_rim();
  const LeafView view = view_of(parts, kGreen);
  ClickSelection selection = taken(parts, view);
  selection.apply(view, click({62.5f, 30.5f}, SeedLabel::kRest));
  CHECK(object(selection, kRim) > 0.9 * kAllOfRim);
}

TEST_CASE("region by colour: a scribble takes what is under it") {
  const PartHierarchy parts = stone_with_rim();
  const LeafView view = view_of(parts, kGreen);
  ClickSelection selection = taken(parts, view);
  Stroke scribble = click({57, 30}, SeedLabel::kRest);
  scribble.points_px.emplace_back(57, 33);
  selection.apply(view, scribble);
  CHECK(object(selection, kRim) > 0.7 * kAllOfRim);
  CHECK(object(selection, kRim) < kAllOfRim);
}

TEST_CASE("region by colour: a click on the object takes back what colour took, not what a click decided") {
  const PartHierarchy parts = stone_with_rim();
  const LeafView view = view_of(parts, kGreen);
  ClickSelection selection = taken(parts, view);
  selection.apply(view, click({57, 30}, SeedLabel::kRest));
  const auto at = [&](int x, int y) { return selection.labels()[static_cast<std::size_t>(y * kWidth + x)]; };
  REQUIRE(at(57, 30) == 0);
  REQUIRE(at(57, 14) == 0);
  selection.apply(view, click({57, 14}, SeedLabel::kObject));
  CHECK(at(57, 14) == 1);
  CHECK(at(57, 20) == 1);
  CHECK(at(57, 30) == 0);
}
