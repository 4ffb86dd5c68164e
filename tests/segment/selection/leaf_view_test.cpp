// Pictures of labellings from a soft view, and distances in masks, against their definitions.
#include "segment/selection/leaf_view.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "core/counter_rng.h"
#include "four_leaves.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/levels_in_view.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kViewWidthPx = 40, kViewHeightPx = 30;

// Of each pixel the four leaves have shares that a random share of it makes up, often nearly all one leaf's.
LeafView random_view(const PartHierarchy& parts) {
  CounterRng rng(5, 1);
  Image<std::vector<GroupWeight>> lists(kViewWidthPx, kViewHeightPx);
  for (std::vector<GroupWeight>& list : lists.pixels()) {
    float left = rng.below(4) == 0 ? rng.unit() : 1;
    for (std::uint32_t leaf = 0; leaf < 4; ++leaf) {
      list.push_back({(leaf + static_cast<std::uint32_t>(rng.below(4))) % 4, left * rng.unit()});
      left -= list.back().weight;
    }
  }
  Camera camera;
  camera.width_px = kViewWidthPx;
  camera.height_px = kViewHeightPx;
  return leaf_view_of(parts, camera, listed(lists), Image<float>(kViewWidthPx, kViewHeightPx, 1.0f));
}

float share(std::span<const GroupWeight> list, const auto& counts) {
  float sum = 0;
  for (const GroupWeight& w : list) sum += counts(w.group) ? w.weight : 0;
  return sum;
}

}  // namespace

TEST_CASE("leaf view: a pixel of its picture is the leaf's that makes most of it, if anything does") {
  const LeafView view = random_view(four_leaves());
  const LeafPicture picture = picture_of(view);
  for (std::size_t i = 0; i < picture.leaf.size(); ++i) {
    const std::span<const GroupWeight> shares = view.leaves.at(i);
    const std::uint32_t leaf = picture.leaf.pixels()[i];
    REQUIRE((leaf != kNoPart) == (share(shares, [](std::uint32_t) { return true; }) >= 0.5f));
    if (leaf != kNoPart) REQUIRE(std::ranges::max(shares, {}, &GroupWeight::weight).group == leaf);
  }
}

TEST_CASE("leaf view: a pixel is object where half of it is, and from the level at which half of it is") {
  const PartHierarchy parts = four_leaves();
  const LeafView view = random_view(parts);
  const std::vector<std::uint8_t> labels = {0, 1, 0, 1};
  const std::vector<std::uint32_t> level = {3, 1, kNoLevel, 5};
  for (const PixelWeights* weights : {&view.gaussians, &view.leaves}) {
    const Mask mask = shown(*weights, view.camera, labels);
    for (std::size_t i = 0; i < mask.size(); ++i)
      REQUIRE((mask.pixels()[i] != 0) ==
              (share(weights->at(i), [&](std::uint32_t g) { return labels[g] != 0; }) >= 0.5f));
  }
  const Image<std::uint32_t> from = shown_from(view, level);
  std::array<int, 4> met{};
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::uint32_t first = kNoLevel;
    for (const std::uint32_t l : {5u, 3u, 1u})
      if (share(view.leaves.at(i), [&](std::uint32_t g) { return level[g] <= l; }) >= 0.5f) first = l;
    REQUIRE(from.pixels()[i] == first);
    ++met[first == kNoLevel ? 0 : first / 2 + 1];
  }
  CHECK(std::ranges::min(met) > 20);
}

TEST_CASE("masks: distances inside are to the nearest pixel outside, the picture's frame included") {
  CounterRng rng(7, 1);
  for (const int margin_px : {0, 6}) {
    Mask mask(kViewWidthPx, kViewHeightPx);
    for (int y = margin_px; y < kViewHeightPx - margin_px; ++y)
      for (int x = margin_px; x < kViewWidthPx - margin_px; ++x)
        mask.at(x, y) = rng.below(40) ? kMaskObject : 0;
    const Image<float> distance = distance_inside(mask);
    for (int y = 0; y < kViewHeightPx; ++y)
      for (int x = 0; x < kViewWidthPx; ++x) {
        int nearest2 = std::numeric_limits<int>::max();
        for (int v = -1; v <= kViewHeightPx; ++v)
          for (int u = -1; u <= kViewWidthPx; ++u)
            if (!mask.contains(u, v) || !mask.at(u, v))
              nearest2 = std::min(nearest2, (u - x) * (u - x) + (v - y) * (v - y));
        REQUIRE(distance.at(x, y) == doctest::Approx(std::sqrt(nearest2)));
      }
  }
  CHECK(distance_inside(Mask(4, 3)) == Image<float>(4, 3, 0.0f));
}

// A block of 9 x 5 pixels and one that touches it at a corner alone; the first index changes its left third.
TEST_CASE("levels in view: how central a pixel is in what has changed by an index") {
  const PartHierarchy parts = four_leaves();
  Camera camera;
  camera.width_px = kViewWidthPx;
  camera.height_px = kViewHeightPx;
  Image<std::int32_t> hit(kViewWidthPx, kViewHeightPx, -1);
  const auto block = [&](int x0, int y0, int x1, int y1, std::int32_t leaf) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) hit.at(x, y) = leaf;
  };
  block(10, 10, 13, 15, 0);
  block(13, 10, 19, 15, 1);
  block(19, 15, 39, 29, 1);
  const LeafView view = leaf_view_of_hits(parts, camera, hit);
  const LevelsInView levels = levels_in_view(view, std::vector<std::uint32_t>{0, 1, kNoLevel, kNoLevel}, 2);
  CHECK(levels.box[0] == PixelRect{10, 10, 13, 15});
  CHECK(levels.box[1] == PixelRect{10, 10, 39, 29});
  // In the left third the largest distance is 2, in its middle column; in the whole block 3, in its middle.
  CHECK(centrality(levels, 0, {11, 12}) == 1);
  CHECK(centrality(levels, 0, {10, 12}) == 0.5f);
  CHECK(centrality(levels, 1, {11, 12}) == doctest::Approx(2.0 / 3));
  CHECK(centrality(levels, 1, {14, 12}) == 1);
  CHECK(centrality(levels, 1, {0, 0}) == 1);  // alone
}
