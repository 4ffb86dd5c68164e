// Boxes: terms, votes and what they change, by hand on four stripes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "four_stripes.h"
#include "segment/masks/seeds.h"
#include "segment/selection/box_by_colour.h"
#include "segment/selection/box_meanings.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr SeedLabel kObject = SeedLabel::kObject, kRest = SeedLabel::kRest;

// Around columns from..to of the picture of 40 x 10 pixels.
Stroke columns(float from, float to, SeedLabel label = kObject) {
  return box_around({to, 0}, {from, 10}, label);
}

// The shipped costs of a box, and borders alone of clicks.
SelectionModel boxes_and_borders() {
  SelectionModel model = borders_alone();
  model.box = SelectionModel().box;
  return model;
}

Labels boxed(const Strokes& strokes) {
  return selected(strokes, boxes_and_borders());
}

const PartMeaning& of_node(const std::vector<PartMeaning>& found, std::uint32_t node) {
  const auto it = std::ranges::find(found, node, &PartMeaning::node);
  REQUIRE(it != found.end());
  return *it;
}

}  // namespace

TEST_CASE("box: it means what fills it, of any size and wherever its middle is") {
  CHECK(boxed({columns(0, 20)}) == Labels{1, 1, 0, 0});
  CHECK(boxed({columns(20, 40)}) == Labels{0, 0, 1, 1});
  CHECK(boxed({columns(0, 40)}) == Labels{1, 1, 1, 1});
  for (int leaf = 0; leaf < 4; ++leaf) {
    Labels alone(4, 0);
    alone[static_cast<std::size_t>(leaf)] = 1;
    const auto left = static_cast<float>(10 * leaf);
    CHECK(boxed({columns(left, left + 10)}) == alone);
    CHECK(boxed({columns(left - 1, left + 11)}) == alone);  // drawn loosely, beyond the picture, too
    CHECK(boxed({columns(left + 0.5f, left + 10)}) == alone);
  }
}

TEST_CASE("box: its terms, worked out by hand") {
  const PartHierarchy parts = four_leaves();
  TermValues fills_alone{};
  weight(&fills_alone, Term::kFills) = 2;
  const LeafView view = stripes(parts);
  const auto found = BoxMeanings(parts, view, {{0, 0}, {20, 10}}, fills_alone).all();
  // Leaves 2 and 3 and their pair do not show in the box.
  CHECK(found.size() == 4);
  // Twenty bins across are a column of ten pixels each. The first hundredth of leaf 0 is a tenth of a bin:
  // the leaf ends that far inside of the tenth of the twenty.
  const PartMeaning& leaf = of_node(found, 0);
  CHECK(weight(leaf.terms, Term::kShort) == doctest::Approx((10 + 0.1) / 20 - 0.1));
  CHECK(weight(leaf.terms, Term::kFills) == doctest::Approx(std::log(2.0)));
  CHECK(weight(leaf.terms, Term::kSpill) == 0);
  CHECK(weight(leaf.terms, Term::kCut) == 0);  // of length 1, around an area of 1
  CHECK(leaf.cost == doctest::Approx(2 * std::log(2.0)));
  const PartMeaning& pair = of_node(found, 4);
  CHECK(weight(pair.terms, Term::kShort) == 0);
  CHECK(weight(pair.terms, Term::kFills) == doctest::Approx(0));
  const PartMeaning& all = of_node(found, 6);
  CHECK(weight(all.terms, Term::kSpill) == doctest::Approx(1));  // as much outside as inside
  CHECK(std::ranges::is_sorted(found, {}, &PartMeaning::cost));
  CHECK(BoxMeanings(parts, view, {{5, 5}, {5, 9}}, fills_alone).all().empty());
}

// Three trees: two hold leaves 0 and 1 as one part, one holds 0 and 2.
TEST_CASE("box: trees vote, by how likely their parts are") {
  PartHierarchy parts = four_leaves();
  parts.trees.assign(3, parts.trees.front());
  parts.trees[2].parent = {4, 5, 4, 5, 6, 6, kNoPart};
  const auto meaning = [](std::uint32_t tree, std::uint32_t node, float cost) {
    return PartMeaning{.tree = tree, .node = node, .terms = {}, .cost = cost};
  };
  const std::vector<PartMeaning> found = {meaning(2, 4, 0), meaning(0, 4, 0.5f), meaning(1, 4, 0.5f),
                                          meaning(0, 6, 3)};
  const float vote = std::exp(-0.5f), all = 1 + 2 * vote;
  const std::vector<float> shares = vote_shares(parts, found);
  REQUIRE(shares.size() == 4);
  CHECK(shares[0] == doctest::Approx(1));
  CHECK(shares[1] == doctest::Approx(2 * vote / all));
  CHECK(shares[2] == doctest::Approx(1 / all));
  CHECK(shares[3] == 0);
  CHECK(majority(shares) == Labels{1, 1, 0, 0});
  // The third tree alone, and none.
  CHECK(majority(vote_shares(parts, std::span(found).first(1))) == Labels{1, 0, 1, 0});
  CHECK(vote_shares(parts, {}).empty());
}

// Leaves 0 and 1 have most of the votes, leaf 2 a minority, leaf 3 next to none.
TEST_CASE("box: what a minority of the trees holds belongs to it where the box would stay empty without") {
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const TermValues weights = SelectionModel().box;
  const std::vector<float> shares = {0.6f, 0.6f, 0.4f, 0.1f};
  const auto agreed = [&](float to_px) {
    return BoxMeanings(parts, view, {{0, 0}, {to_px, 10}}, weights).agreed(shares);
  };
  CHECK(agreed(20) == Labels{1, 1, 0, 0});
  CHECK(agreed(22) == Labels{1, 1, 0, 0});  // drawn loosely
  // 10 of 30 columns empty: 3 (1/3 - .1) + .7 ln 1.5 = .98 against .3 + .5 (.5 - .4) = .35.
  CHECK(agreed(30) == Labels{1, 1, 1, 0});
  const std::vector<float> torn = {0.4f, 0.3f, 0.3f, 0};  // there is no majority to add to
  for (const std::vector<float>& none : {torn, {}})
    CHECK(BoxMeanings(parts, view, {{0, 0}, {30, 10}}, weights).agreed(none) == Labels{0, 0, 0, 0});
}

TEST_CASE("box: clicks correct it, and it leaves what clicks have decided") {
  CHECK(boxed({columns(0, 20), object(5), rest(15)}) == Labels{1, 0, 0, 0});
  CHECK(boxed({columns(0, 20), object(35)}) == Labels{1, 1, 1, 1});
  CHECK(boxed({object(5), rest(15), columns(0, 20)}) == Labels{1, 0, 0, 0});
  CHECK(boxed({object(5), columns(20, 40)}) == Labels{1, 1, 1, 1});
  CHECK(boxed({object(5), columns(10, 20, kRest)}) == Labels{1, 0, 0, 0});
  CHECK(boxed({columns(10, 20, kRest)}) == Labels{0, 0, 0, 0});  // there is no object yet
}

TEST_CASE("box: where nothing is, it is refused") {
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts, {0, -1, 2, 3});
  ClickSelection selection(parts, boxes_and_borders());
  CHECK_FALSE(selection.apply(view, columns(11, 19)));
  CHECK_FALSE(selection.any());
  CHECK(selection.apply(view, columns(0, 19)));
  CHECK(selection.labels() == Labels{1, 1, 0, 0});  // leaf 1 is out of sight and belongs to it
}

TEST_CASE("box: what else it can mean looks clearly different, and is taken when chosen") {
  const PartHierarchy parts = four_leaves();
  const SelectionModel model = boxes_and_borders();
  const LeafView view = stripes(parts);
  std::vector<Labels> meant;
  for (int choice = 0; choice < kMostMeanings; ++choice) {
    ClickSelection selection(parts, model, choice);
    REQUIRE(selection.apply(view, columns(0, 20)));
    REQUIRE(selection.meanings().size() == kMostMeanings);
    CHECK(selection.choice() == static_cast<std::size_t>(choice));
    CHECK(selection.meanings()[static_cast<std::size_t>(choice)] ==
          shown(view.gaussians, view.camera, selection.labels()));
    meant.push_back(selection.labels());
  }
  CHECK(meant[0] == Labels{1, 1, 0, 0});
  CHECK(meant[1] != meant[0]);
  CHECK(meant[2] != meant[0]);
  CHECK(meant[2] != meant[1]);
}

TEST_CASE(
    "box: what differs in colour from all around is meant though no part is it, and what shares it is not") {
  const PartHierarchy parts = four_leaves();
  const auto view_of = [&](const std::array<Rgb8, 4>& colours) {
    LeafView view = stripes(parts);
    view.colour = Image<Rgb8>(40, 10);
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 40; ++x) {
        view.colour.at(x, y) = colours[static_cast<std::size_t>(x / 10)];
        view.colour.at(x, y)[1] += static_cast<std::uint8_t>((3 * x + 5 * y) % 7);
      }
    return view;
  };
  const auto meant = [&](const LeafView& view, const Stroke& box, int choice = 0) {
    ClickSelection selection(parts, boxes_and_borders(), choice);
    REQUIRE(selection.apply(view, box));
    return selection.labels();
  };
  constexpr Rgb8 kRed{200, 40, 40}, kBlue{40, 40, 200};
  const Stroke middle = columns(10, 30);
  const Labels by_parts = meant(stripes(parts), middle);
  REQUIRE(by_parts != Labels{0, 1, 1, 0});  // the trees hold 0 with 1, and 2 with 3
  const LeafView stands_out = view_of({kBlue, kRed, kRed, kBlue});
  CHECK(meant(stands_out, middle) == Labels{0, 1, 1, 0});
  CHECK(meant(stands_out, middle, 1) == by_parts);
  CHECK(meant(view_of({kBlue, kBlue, kBlue, kBlue}), middle) == by_parts);
  CHECK(meant(view_of({kRed, kRed, kRed, kBlue}), columns(0, 20)) == Labels{1, 1, 0, 0});
}

TEST_CASE("box: what is known of it by colour is not found again, of another box it is") {
  const PartHierarchy parts = four_leaves();
  LeafView view = stripes(parts);
  view.colour = Image<Rgb8>(40, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x)
      view.colour.at(x, y) = {static_cast<std::uint8_t>(x >= 10 && x < 30 ? 200 : 40),
                              static_cast<std::uint8_t>((3 * x + 5 * y) % 7), 40};
  const Labels found = leaves_by_colour(parts, view, columns(10, 30));
  CHECK(found == Labels{0, 1, 1, 0});
  KnownByColour known{columns(10, 30).points_px, {1, 0, 0, 1}};
  CHECK(known.of(parts, view, columns(10, 30)) == Labels{1, 0, 0, 1});
  CHECK(known.of(parts, view, columns(9, 30)) == found);
  CHECK(known.box_px == columns(9, 30).points_px);
}

// Single stripes are the likeliest of clicks by far. What a box holds, and what a click wants, no pair does.
TEST_CASE("box: a click may say that it meant another part, if that is hardly dearer") {
  PartHierarchy parts = four_leaves();
  parts.trees.front().cut = {0.001f, 0.001f, 0.001f, 0.001f, 1, 1, 4};
  const LeafView view = stripes(parts);
  SelectionModel model = boxes_and_borders();
  weight(&model.box, Term::kCut) = 0;
  const auto after = [&](const Strokes& strokes) {
    ClickSelection selection(parts, model);
    for (const Stroke& stroke : strokes) selection.apply(view, stroke);
    return selection.labels();
  };
  const auto dearer_by = [&](const BoxPx& box, std::uint32_t node) {
    const std::vector<PartMeaning> found = BoxMeanings(parts, view, box, model.box).all();
    return of_node(found, node).cost - found.front().cost;
  };
  const Strokes larger = {columns(0, 25), object(25)};  // the pair that holds it spills more than all four
  const Strokes smaller = {columns(0, 40), rest(25)};   // the other pair fills more than a stripe
  REQUIRE(after({larger.front()}) == Labels{1, 1, 0, 0});
  REQUIRE(after({smaller.front()}) == Labels{1, 1, 1, 1});
  CHECK(after(larger) == Labels{1, 1, 1, 0});
  CHECK(after(smaller) == Labels{1, 1, 0, 1});
  weight(&model.later, Term::kAgreed) = -50;
  // A stripe alone costs ln 0.001 = -6.9, which is 43.1 more.
  weight(&model.later, Term::kDearer) = 42 / dearer_by({{0, 0}, {25, 10}}, 6);
  CHECK(after(larger) == Labels{1, 1, 1, 1});
  weight(&model.later, Term::kDearer) = 44 / dearer_by({{0, 0}, {25, 10}}, 6);
  CHECK(after(larger) == Labels{1, 1, 1, 0});
  weight(&model.later, Term::kDearer) = 42 / dearer_by({{0, 0}, {40, 10}}, 4);
  CHECK(after(smaller) == Labels{1, 1, 0, 0});
  weight(&model.later, Term::kDearer) = 44 / dearer_by({{0, 0}, {40, 10}}, 4);
  CHECK(after(smaller) == Labels{1, 1, 0, 1});
}

TEST_CASE("box: what was clicked is not given up for another of its meanings") {
  PartHierarchy parts = four_leaves();
  parts.trees.front().cut = {0.001f, 0.001f, 0.001f, 0.001f, 1, 1, 4};
  const LeafView view = stripes(parts);
  SelectionModel model = boxes_and_borders();
  weight(&model.later, Term::kAgreed) = -50;
  ClickSelection selection(parts, model);
  for (const Stroke& stroke : Strokes{columns(0, 25), rest(35), object(25)}) selection.apply(view, stroke);
  CHECK(selection.labels() == Labels{1, 1, 1, 0});  // what holds the third stripe and more holds the fourth
}

TEST_CASE("box: to pixels alone it says that what is outside is the rest, and its middle the object") {
  const Image<std::uint8_t> seeds = draw_seeds({box_around({2, 1}, {12, 9}, kObject)}, 16, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 16; ++x) {
      CAPTURE(x);
      CAPTURE(y);
      const bool inside = x >= 2 && x < 12 && y >= 1 && y < 9;
      const bool middle = std::hypot(x + 0.5 - 7, y + 0.5 - 5) <= 2;
      CHECK(seeds.at(x, y) == (middle ? kObjectSeed : inside ? kNoSeed : kRestSeed));
    }
  const Image<std::uint8_t> out = draw_seeds({box_around({2, 1}, {12, 9}, kRest)}, 16, 10);
  CHECK(out.at(7, 5) == kRestSeed);
  CHECK(out.at(1, 5) == kNoSeed);
}
