// What two trees disagree about: by hand on stripes, of which the first two are red and the last is green.
#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "four_stripes.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/settled_by_colour.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr Rgb8 kRed{200, 30, 30}, kLeafGreen{40, 160, 40};
constexpr std::uint32_t kPair = 4, kAll = 6;  // nodes of four_leaves()

PartHierarchy disagreeing_trees() {
  PartHierarchy parts = four_leaves();
  parts.trees.push_back(parts.trees.front());
  return parts;
}

// The third stripe has that colour. What stands behind the last stripe is no leaf, unless leaf 3 does. Depth
// jumps at the third stripe, so that a border there costs nothing.
LeafView coloured(const PartHierarchy& parts, const Rgb8& third, bool last_shows = false) {
  LeafView view = stripes(parts, {0, 1, 2, last_shows ? 3 : -1});
  view.colour = Image<Rgb8>(40, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) {
      view.colour.at(x, y) = x < 20 ? kRed : x < 30 ? third : kLeafGreen;
      view.depth.at(x, y) = x < 20 ? 1 : x < 30 ? 4 : 16;
    }
  return view;
}

// Three stripes 10 pixels below the top of 60 x 30 and so far from its left, on green; the third has that
// colour, the others are red.
LeafView on_green(const PartHierarchy& parts, const Rgb8& third, int left) {
  Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, 60, 30);
  camera.fx_px = camera.fy_px = 100;
  Image<std::int32_t> hit(60, 30, -1);
  Image<Rgb8> colour(60, 30, kLeafGreen);
  for (int y = 10; y < 20; ++y)
    for (int x = 0; x < 30; ++x) {
      hit.at(left + x, y) = x / 10;
      colour.at(left + x, y) = x < 20 ? kRed : third;
    }
  LeafView view = leaf_view_of_hits(parts, camera, hit);
  for (float& depth : view.depth.pixels()) depth = 1;
  view.colour = std::move(colour);
  return view;
}

// One tree holds the pair alone, the other all, at a cost that is so much higher.
std::vector<PartMeaning> disagreeing(float dearer) {
  return {{0, kPair, {}, 1}, {1, kAll, {}, 1 + dearer}};
}

}  // namespace

TEST_CASE("settled by colour: what looks like the object joins it where the trees are not too sure") {
  // The other tree's share is s = 1 / (1 + e^c), so ln(s / (1 - s)) = -c. The third stripe counts as rest by
  // 1 - s of its pixels, beside as many green ones: r = ln(1 / ((1 - s) / (2 - s))) = ln(2 + e^-c). Their sum
  // is above 0 while e^c is below 1 + sqrt(2): c below .88.
  const PartHierarchy parts = disagreeing_trees();
  const LeafView view = coloured(parts, kRed);
  const Labels pair{1, 1, 0, 0};
  CHECK(settled_by_colour(parts, view, disagreeing(0.85f), pair) == Labels{1, 1, 1, 1});  // 3 is hidden
  CHECK(settled_by_colour(parts, view, disagreeing(0.91f), pair) == pair);
}

TEST_CASE("settled by colour: what looks like the rest leaves the object") {
  const PartHierarchy parts = disagreeing_trees();
  const std::vector<PartMeaning> all_first = {{1, kAll, {}, 1}, {0, kPair, {}, 1.5f}};
  const Labels pair{1, 1, 0, 0}, all{1, 1, 1, 1};
  CHECK(settled_by_colour(parts, coloured(parts, kLeafGreen), all_first, all) == pair);
  CHECK(settled_by_colour(parts, coloured(parts, kRed), all_first, all) == all);
}

TEST_CASE("settled by colour: the border goes to where the picture has an edge") {
  // Both trees hold the pair, so the third stripe's 100 pixels are rest by ln 9. Of the 800 pixels within
  // half of the pair's extent 200 are the pair's and 100 the third stripe's, as red: by ln(600 / 100) they
  // are object, 41 are left for rest. A border at the stripe crosses 10 rows and 18 diagonals without an
  // edge: 12 (10 + 18 / sqrt 2) = 273. Around the stripes colour has one, where a border costs next to
  // nothing.
  const PartHierarchy parts = disagreeing_trees();
  const std::vector<PartMeaning> agreed = {{0, kPair, {}, 1}, {1, kPair, {}, 1}};
  const Labels pair{1, 1, 0, 0}, with_third{1, 1, 1, 0};
  LeafView view = on_green(parts, kRed, 10);
  CHECK(settled_by_colour(parts, view, agreed, pair) == with_third);
  CHECK(settled_by_colour(parts, on_green(parts, kLeafGreen, 10), agreed, pair) == pair);
  for (int y = 0; y < 30; ++y)
    for (int x = 30; x < 40; ++x) view.depth.at(x, y) = 4;  // behind the pair
  CHECK(settled_by_colour(parts, view, agreed, pair) == pair);
  // 10 of 180 pixels of the frame are the pair's.
  CHECK(settled_by_colour(parts, on_green(parts, kRed, 0), agreed, pair) == pair);
}

TEST_CASE("settled by colour: other meanings are no doubts, and nothing is settled without colour") {
  const PartHierarchy parts = disagreeing_trees();
  const Labels pair{1, 1, 0, 0};
  // Seen whole, all is twice the pair: another thing.
  CHECK(settled_by_colour(parts, coloured(parts, kRed, true), disagreeing(0), pair) == pair);
  LeafView grey = coloured(parts, kRed);
  grey.colour = {};
  CHECK(settled_by_colour(parts, grey, disagreeing(0), pair) == pair);
  CHECK(settled_by_colour(parts, coloured(parts, kRed), {}, pair) == pair);
}

TEST_CASE("settled by colour: a first click is, and its sizes and offers begin there") {
  // Each tree's cheapest part by its border: the pair of the first, all of the second, which is .8 dearer.
  PartHierarchy parts = disagreeing_trees();
  for (PartTree& tree : parts.trees) tree.cut = {9, 9, 9, 9, 9, 9, 9};
  parts.trees[0].cut[kPair] = 0.01f * std::sqrt(parts.trees[0].area[kPair]);
  parts.trees[1].cut[kAll] = 0.01f * std::exp(0.8f) * std::sqrt(parts.trees[1].area[kAll]);
  for (const auto& [third, expected] :
       {std::pair{kRed, Labels{1, 1, 1, 1}}, std::pair{kLeafGreen, Labels{1, 1, 0, 0}}}) {
    ClickSelection selection(parts, borders_alone());
    const LeafView view = coloured(parts, third);
    REQUIRE(selection.apply(view, object(5)));
    CHECK(selection.labels() == expected);
    REQUIRE(!selection.meanings().empty());
    CHECK(iou(selection.meanings()[0], shown(view.leaves, view.camera, expected)) == 1);
    CHECK(iou(selection.size_masks()[selection.size()], selection.meanings()[0]) == 1);
  }
}
