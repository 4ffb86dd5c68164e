// What clicks and scribbles after the first change: by hand on four stripes.
#include <doctest/doctest.h>

#include "four_stripes.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("selection: clicks on four stripes, worked out by hand") {
  // The pair has the least border for its size: ln(0.001 / sqrt 2) against ln 1 of a leaf.
  CHECK(selected({object(5)}) == Labels{1, 1, 0, 0});
  CHECK(selected({object(35)}) == Labels{0, 0, 1, 1});
  CHECK(selected({object(5), object(25)}) == Labels{1, 1, 1, 1});
  CHECK(selected({object(5), rest(15)}) == Labels{1, 0, 0, 0});
  // What is displayed as said already stays as it is.
  CHECK(selected({object(5), object(7)}) == Labels{1, 1, 0, 0});
  CHECK(selected({object(5), rest(35)}) == Labels{1, 1, 0, 0});
  // A rest click before there is an object waits for nothing: it is not an object's correction.
  CHECK(selected({rest(35)}) == Labels{0, 0, 0, 0});
}

TEST_CASE("selection: where the object was left out of the picture, a click adds what is seen behind it") {
  const PartHierarchy parts = four_leaves();
  ClickSelection selection(parts, borders_alone());
  selection.apply(stripes(parts), object(5));
  LeafView behind = stripes(parts, {2, 2, 2, 3});
  behind.whole = false;
  ClickSelection as_shown = selection;
  CHECK(as_shown.apply(behind, object(5)));
  CHECK(as_shown.labels() == Labels{1, 1, 1, 1});
  CHECK_FALSE(as_shown.spot_alone());
}

TEST_CASE("selection: a click that no part fits changes its spot and says so, one at the border does not") {
  SelectionModel nothing_likely = borders_alone();
  weight(&nothing_likely.later, Term::kDisc) = -100;
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  for (const auto& [x, alone] : {std::pair{30.0f, true}, {22.0f, false}}) {
    CAPTURE(x);
    ClickSelection selection(parts, nothing_likely);
    selection.apply(view, object(5));
    CHECK_FALSE(selection.spot_alone());
    selection.apply(view, object(x));
    CHECK(selection.spot_alone() == alone);
  }
}

TEST_CASE("selection: a click on what is shown so already holds it and flips nothing that shines through") {
  PartHierarchy parts = four_leaves();
  LeafView view = stripes(parts);
  ClickSelection selection(parts, borders_alone());
  selection.apply(view, object(5));
  // Leaf 1 shines through leaf 3 in another view, and nowhere else.
  LeafView other = stripes(parts, {-1, -1, 2, 3});
  PixelWeights veiled;
  veiled.first.push_back(0);
  for (std::size_t i = 0; i < 400; ++i) {
    for (const GroupWeight& w : other.gaussians.at(i)) veiled.entry.push_back({w.group, 0.9f});
    if (!other.gaussians.at(i).empty() && other.gaussians.at(i).front().group == 3)
      veiled.entry.push_back({1, 0.1f});
    veiled.first.push_back(static_cast<std::uint32_t>(veiled.entry.size()));
  }
  other.gaussians = veiled;
  selection.apply(other, rest(35));
  CHECK(selection.labels() == Labels{1, 1, 0, 0});
}

// All four stripes are taken by one click on the first, then a click on the second says rest. No part of the
// tree holds all but the first: only the first click's smallest meaning leaves the second out.
TEST_CASE(
    "selection: a rest click may give the first click another meaning, where it is as large as it says") {
  SelectionModel model = borders_alone();
  weight(&model.first, Term::kCut) = 0.5f;       // the least likely meaning is still one
  weight(&model.later, Term::kOffCentre) = 100;  // not of it: it has no place in the view
  weight(&model.later, Term::kHidden) = 100;     // nor this, though half of what it gives up is out of sight
  weight(&model.later, Term::kRepick) = -50;
  const PartHierarchy parts = four_leaves();
  const auto after = [&](const std::vector<int>& columns, const Strokes& strokes) {
    const LeafView view = stripes(parts, columns);
    ClickSelection selection(parts, model);
    for (const Stroke& stroke : strokes) selection.apply(view, stroke);
    return selection.labels();
  };
  // The border is 5 pixels away: up to e pi 5^2 = 213 pixels may go. Two stripes are 200, three are 300.
  const std::vector<int> two_more = {0, 1, 2, -1}, three_more = {0, 1, 2, 3};
  CHECK(after(two_more, {sized(object(5), 1)}) == Labels{1, 1, 1, 1});
  CHECK(after(two_more, {sized(object(5), 1), rest(15)}) == Labels{1, 0, 0, 0});
  CHECK(after(three_more, {sized(object(5), 1), rest(15)}) == Labels{1, 0, 1, 1});
  // After two object clicks a single part is no other meaning of the one.
  CHECK(after(two_more, {sized(object(5), 1), object(7), rest(15)}) == Labels{1, 0, 1, 1});
  weight(&model.later, Term::kRepick) = 50;
  CHECK(after(two_more, {sized(object(5), 1), rest(15)}) == Labels{1, 0, 1, 1});
}

namespace {

// Two trees, ((0 1) (2 3)) and ((0 2) (1 3)): without the second stripe, a first click meant the first one
// alone, or the first and the third. leaf_cut: length of the border of each stripe.
PartHierarchy first_stripe_or_pair(float leaf_cut) {
  PartHierarchy parts = four_leaves();
  parts.trees.front().cut = {leaf_cut, leaf_cut, leaf_cut, leaf_cut, 2, 2, 4};
  PartTree other = parts.trees.front();
  other.parent = {4, 5, 4, 5, 6, 6, kNoPart};
  other.children[4] = {0, 2};
  other.children[5] = {1, 3};
  other.cut[4] = 1.4f;
  other.cut[5] = 2 * leaf_cut;
  parts.trees.push_back(other);
  parts.plain_trees = 2;
  return parts;
}

}  // namespace

TEST_CASE("selection: a rest click takes back what the trees agree that the first click did not mean") {
  // The other tree's vote counts 1; that for the first stripe 1.4 / sqrt(2).
  const PartHierarchy parts = first_stripe_or_pair(1);
  SelectionModel model = borders_alone();
  weight(&model.later, Term::kAgreed) = -50;
  const auto after = [&](float doubtful, const Strokes& strokes) {
    weight(&model.later, Term::kDoubtful) = doubtful;
    const LeafView view = stripes(parts);
    ClickSelection selection(parts, model);
    for (const Stroke& stroke : strokes) selection.apply(view, stroke);
    return selection.labels();
  };
  CHECK(after(0, {sized(object(5), 10)}) == Labels{1, 1, 1, 1});
  // A second click on the object, as one alone may mean another part of this size without any vote.
  const Strokes clicks = {sized(object(5), 10), object(7), rest(15)};
  CHECK(after(0, clicks) == Labels{1, 0, 1, 0});
  // .4975 of the votes are against the third stripe, which is half of what is meant: the doubt is .2487. It
  // outweighs the cost of -50 from 50 / .2487 = 201 on.
  CHECK(after(195, clicks) == Labels{1, 0, 1, 0});
  CHECK(after(207, clicks) == Labels{1, 0, 1, 1});
  // After a single click on the object the change is as small as the click says, and doubted as much.
  weight(&model.later, Term::kRepick) = -50;
  CHECK(after(195, {sized(object(5), 10), rest(15)}) == Labels{1, 0, 1, 0});
  CHECK(after(207, {sized(object(5), 10), rest(15)}) == Labels{1, 0, 1, 1});
  // A click on the third stripe leaves the one tree that has a part for it.
  CHECK(after(1e6f, {sized(object(5), 10), object(25), rest(15)}) == Labels{1, 0, 1, 0});
}

TEST_CASE("selection: another meaning that is too dear is no answer, though others are dearer") {
  // The second stripe alone costs ln(e^3) = 3, and with the last one 3.3. After one object click alone the
  // likeliest part would be asked.
  const PartHierarchy parts = first_stripe_or_pair(std::exp(3.0f));
  SelectionModel model = borders_alone();
  weight(&model.later, Term::kDisc) = 3;
  const LeafView view = stripes(parts);
  for (const auto& [cost, expected] :
       {std::pair{0.35f, Labels{1, 0, 1, 0}}, std::pair{0.45f, Labels{1, 0, 1, 1}}}) {
    weight(&model.later, Term::kAgreed) = cost;
    ClickSelection selection(parts, model);
    for (const Stroke& stroke : {sized(object(5), 10), object(7), rest(15)}) selection.apply(view, stroke);
    CHECK(selection.labels() == expected);
  }
}

TEST_CASE("selection: a second click on the object may say that the first meant what holds both") {
  PartHierarchy parts = four_leaves();
  parts.trees.front().cut = {0.001f, 0.001f, 0.001f, 0.001f, 1, 1, 4};
  SelectionModel model = borders_alone();
  weight(&model.first, Term::kCut) = 0.5f;  // the least likely meaning is still one
  const LeafView view = stripes(parts);
  const auto after = [&](const Strokes& strokes) {
    ClickSelection selection(parts, model);
    for (const Stroke& stroke : strokes) selection.apply(view, stroke);
    return selection.labels();
  };
  const Strokes both = {object(5), object(25)};
  CHECK(after({object(5)}) == Labels{1, 0, 0, 0});
  CHECK(after(both) == Labels{1, 0, 1, 0});
  weight(&model.later, Term::kAgreed) = -50;
  CHECK(after(both) == Labels{1, 1, 1, 1});
  // All four cost (ln 2 - ln 0.001) / 2 = 3.80 more than one; the second stripe alone ln 0.001 = -6.9.
  weight(&model.later, Term::kDearer) = 42 / 3.8f;
  CHECK(after(both) == Labels{1, 1, 1, 1});
  weight(&model.later, Term::kDearer) = 44 / 3.8f;
  CHECK(after(both) == Labels{1, 0, 1, 0});
}

// Single stripes are the likeliest by far, and all four are taken at first.
TEST_CASE("selection: a correction after one of the same sign means what holds both") {
  PartHierarchy parts = four_leaves();
  parts.trees.front().cut = {0.001f, 0.001f, 0.001f, 0.001f, 1, 1, 4};
  SelectionModel model = borders_alone();
  const LeafView view = stripes(parts);
  const auto after = [&](float again, const Strokes& strokes) {
    weight(&model.later, Term::kAgain) = again;
    ClickSelection selection(parts, model);
    for (const Stroke& stroke : strokes) selection.apply(view, stroke);
    return selection.labels();
  };
  CHECK(after(-50, {sized(object(5), 10)}) == Labels{1, 1, 1, 1});
  CHECK(after(-50, {sized(object(5), 10), rest(15)}) == Labels{1, 0, 1, 1});
  CHECK(after(0, {sized(object(5), 10), rest(15), rest(25)}) == Labels{1, 0, 0, 1});
  // The whole tree holds both: the click on the object holds back its pair alone.
  CHECK(after(-50, {sized(object(5), 10), rest(15), rest(25)}) == Labels{1, 0, 0, 0});
  // A click on the object in between has changed its mind.
  CHECK(after(-50, {sized(object(5), 10), rest(15), object(15), rest(25)}) == Labels{1, 1, 0, 1});
  // A box has said how far the thing reaches.
  const Stroke all = box_around({0, 0}, {40, 40}, SeedLabel::kObject);
  CHECK(after(-50, {all, rest(15), rest(25)}) == Labels{1, 0, 0, 1});
  // The sixth correction mends a detail, whatever came before.
  Strokes many = {sized(object(5), 10)};
  for (int i = 0; i < 4; ++i) many.push_back(i % 2 ? object(15) : rest(15));
  many.insert(many.end(), {rest(15), rest(25)});
  CHECK(after(-50, many) == Labels{1, 0, 0, 1});
  many.erase(many.begin() + 1, many.begin() + 3);
  CHECK(after(-50, many) == Labels{1, 0, 0, 0});
  // A click on what is so already, in between, changes nothing.
  CHECK(after(-50, {sized(object(5), 10), rest(15), object(5), rest(25)}) == Labels{1, 0, 0, 0});
}

TEST_CASE("selection: a click is obeyed though no part is likely, by its disc alone") {
  SelectionModel nothing_likely = borders_alone();
  weight(&nothing_likely.later, Term::kDisc) = -100;
  const Labels labels = selected({object(5), object(25)}, nothing_likely);
  CHECK(labels == Labels{1, 1, 1, 0});
}

TEST_CASE("selection: a click on something thin before another surface decides no more than it") {
  PartHierarchy parts = four_leaves();
  parts.leaf_centre_world[2].z = -5;  // a stem, half as far as the rest
  Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, 40, 10);
  camera.fx_px = camera.fy_px = 100;
  Image<std::int32_t> hit(40, 10, 3);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x)
      if (x < 20 || (x >= 31 && x < 34)) hit.at(x, y) = x < 20 ? x / 10 : 2;
  SelectionModel nothing_likely = borders_alone();
  weight(&nothing_likely.later, Term::kDisc) = -100;
  nothing_likely.disc_share = 1;
  nothing_likely.disc_majority = 0.2f;
  for (const auto& [depth, expected] : {std::pair{-5.0f, Labels{1, 1, 1, 0}}, {0.0f, Labels{1, 1, 1, 1}}}) {
    CAPTURE(depth);  // on the surface itself the displayed border is the nearest end there is
    parts.leaf_centre_world[2].z = depth;
    const LeafView view = leaf_view_of_hits(parts, camera, hit);
    ClickSelection selection(parts, nothing_likely);
    selection.apply(view, object(5));
    selection.apply(view, object(32));
    CHECK(selection.labels() == expected);
  }
}

TEST_CASE("selection: a click on the rest pays for what it would leave of the object in the view") {
  // All four stripes are the object. The pair under the click costs ln(0.001 / sqrt 2) = -7.25 and would
  // leave half, ln 2 - 0.4 = 0.293; its leaf costs 0 and would leave three quarters, ln 4/3 < 0.4.
  SelectionModel model = borders_alone();
  CHECK(selected({sized(object(5), 1)}, model) == Labels{1, 1, 1, 1});
  weight(&model.later, Term::kTakes) = 24;
  CHECK(selected({sized(object(5), 1), rest(35)}, model) == Labels{1, 1, 0, 0});
  weight(&model.later, Term::kTakes) = 26;
  CHECK(selected({sized(object(5), 1), rest(35)}, model) == Labels{1, 1, 1, 0});
  // A first correction on the object gives, and pays nothing.
  weight(&model.later, Term::kTakes) = 1000;
  CHECK(selected({object(5), object(25)}, model) == Labels{1, 1, 1, 1});
}

TEST_CASE("selection: a further click on the object pays for what would make it much larger in the view") {
  // The object shows in a quarter of the view. The pair under the click costs ln(0.001 / sqrt 2) = -7.25 and
  // would make it four times as large, ln 4 - 0.7 = 0.686; its leaf costs 0 and would double it, ln 2 < 0.7.
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts), other = stripes(parts, {0, 2, 3, 3});
  for (const auto& [takes, expected] : {std::pair{10.0f, Labels{1, 1, 1, 1}}, {11.0f, Labels{1, 1, 1, 0}}}) {
    SelectionModel model = borders_alone();
    weight(&model.later, Term::kTakes) = takes;
    ClickSelection selection(parts, model);
    selection.apply(view, sized(object(5), -1));
    selection.apply(view, object(15));
    REQUIRE(selection.labels() == Labels{1, 1, 0, 0});
    selection.apply(other, object(15));
    CHECK(selection.labels() == expected);
  }
}

TEST_CASE("selection: of many alike in many trees none wins that a click in its middle would have to mean") {
  // A block before a wall: the click is in the middle of the block, and far off that of both together, which
  // 30 trees hold. ln(0.7 / 0.25) = 1.03 times 10 is more than the -7.25 that their border costs.
  PartHierarchy parts = four_leaves();
  while (parts.trees.size() < 30) parts.trees.push_back(parts.trees.front());
  parts.plain_trees = parts.trees.size();
  Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, 60, 40);
  camera.fx_px = camera.fy_px = 100;
  Image<std::int32_t> hit(60, 40, 3);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      if (x < 20) hit.at(x, y) = x / 10;
      if (x >= 20 && x < 30 && y >= 15 && y < 25) hit.at(x, y) = 2;
    }
  const LeafView view = leaf_view_of_hits(parts, camera, hit);
  SelectionModel model = borders_alone();
  weight(&model.later, Term::kOffCentre) = 10;
  ClickSelection selection(parts, model);
  selection.apply(view, object(5));
  REQUIRE(selection.labels() == Labels{1, 1, 0, 0});
  selection.apply(view, click({25, 20}, SeedLabel::kObject));
  CHECK(selection.labels() == Labels{1, 1, 1, 0});
}

TEST_CASE("selection: what would mostly change where the view does not show it is dear") {
  PartHierarchy parts = four_leaves();
  parts.leaf_area[3] = 1000;
  const LeafView view = stripes(parts, {0, 1, 2, 2});  // the fourth leaf is behind the third
  SelectionModel model = borders_alone();
  for (const bool dear : {false, true}) {
    weight(&model.later, Term::kHidden) = dear ? 4 : 0;
    ClickSelection selection(parts, model);
    selection.apply(view, object(5));
    selection.apply(view, object(25));
    CHECK(selection.labels() == (dear ? Labels{1, 1, 1, 0} : Labels{1, 1, 1, 1}));
  }
}

TEST_CASE("selection: a clicked pixel is obeyed by what is small, not by the wall that shines through") {
  // From the third column on: a wall, two splats and the leaf, of which .65 are to show the object.
  PartHierarchy parts = four_leaves();
  constexpr std::uint32_t kWall = 4, kSplats[] = {5, 6};
  parts.leaf_of.insert(parts.leaf_of.end(), 3, kNoPart);
  const Camera camera = stripes(parts).camera;
  Image<std::vector<GroupWeight>> lists(40, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) {
      const auto leaf = static_cast<std::uint32_t>(x / 10);
      lists.at(x, y) = {{leaf, 1}};
      if (leaf > 1) lists.at(x, y) = {{kWall, 0.33f}, {kSplats[0], 0.31f}, {kSplats[1], 0.26f}, {leaf, 0.1f}};
    }
  LeafView view = leaf_view_of(parts, camera, listed(lists), Image<float>(40, 10, 10.0f));
  for (const bool sizes_known : {false, true}) {
    if (sizes_known) view.alone_px = {100, 100, 100, 100, 1e6f, 10, 10};
    ClickSelection selection(parts, borders_alone());
    selection.apply(view, object(5));
    selection.apply(view, object(25));
    CHECK(shown(view.gaussians, view.camera, selection.labels()).at(25, 5) != 0);
    CHECK(selection.labels()[kWall] == !sizes_known);
    CHECK(selection.labels()[kSplats[1]] == sizes_known);
  }
}

TEST_CASE("selection: a correction leaves what another thing hides it from to its own click") {
  // Of the pair on the left the second leaf lies behind leaf 2, which stands between them in the picture.
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts, {0, 2, 1, 3});
  SelectionModel model = borders_alone();
  const auto labels = [&] {
    ClickSelection selection(parts, model);
    selection.apply(view, object(35));  // 2 and 3
    selection.apply(view, object(5));
    return selection.labels();
  };
  CHECK(labels() == Labels{1, 1, 1, 1});
  weight(&model.later, Term::kApart) = 13;  // half of the pair, against ln 1000
  CHECK(labels() == Labels{1, 1, 1, 1});
  weight(&model.later, Term::kApart) = 15;
  CHECK(labels() == Labels{1, 0, 1, 1});
}

TEST_CASE("selection: what a correction mostly does not reach was hardly meant twice") {
  const PartHierarchy parts = four_leaves();
  // Of the first two stripes a click at 2 reaches so many columns without a jump in depth.
  const auto again_where = [&](int reached) {
    LeafView view = stripes(parts);
    for (int y = 0; y < 10; ++y)
      for (int x = reached; x < 40; ++x) view.depth.at(x, y) *= 3;
    view.steps = steps_without_jump(view.depth);
    ClickSelection selection(parts, borders_alone());
    for (const Stroke& stroke : {sized(object(35), 10), rest(25)}) selection.apply(view, stroke);
    const std::optional<Answers> answers = selection.considered(view, {2, 5}, false, {.all_terms = true});
    REQUIRE(answers);
    float most = 0;  // of the whole tree, which alone holds the click before
    for (const Candidate& c : answers->candidates) most = std::max(most, weight(c.terms, Term::kAgain));
    return most;
  };
  CHECK(again_where(40) == 1);
  CHECK(again_where(10) == 1);
  CHECK(again_where(5) == doctest::Approx(0.5));
  CHECK(again_where(4) == doctest::Approx(0.4));
}

TEST_CASE("selection: a scribble decides all that is under it") {
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  SelectionModel nothing_likely = borders_alone();
  weight(&nothing_likely.later, Term::kDisc) = -100;
  ClickSelection selection(parts, nothing_likely);
  selection.apply(view, object(5));
  selection.apply(view, {.label = SeedLabel::kObject, .radius_px = 1, .points_px = {{23, 5}, {36, 5}}});
  CHECK(selection.labels() == Labels{1, 1, 1, 1});
  selection.apply(view, {.label = SeedLabel::kRest, .radius_px = 1, .points_px = {{13, 5}, {26, 5}}});
  CHECK(selection.labels() == Labels{1, 0, 0, 1});
}

TEST_CASE("selection: a click where nothing is, is refused") {
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts, {0, 1, -1, -1});
  ClickSelection selection(parts, borders_alone());
  CHECK_FALSE(selection.apply(view, object(35)));
  CHECK(selection.labels() == Labels{0, 0, 0, 0});
  CHECK(selection.apply(view, object(5)));
  CHECK_FALSE(selection.apply(view, object(35)));
  CHECK(selection.labels() == Labels{1, 1, 0, 0});
}

TEST_CASE(
    "selection: what the first view hides follows its part, and a click in another view takes it back") {
  const PartHierarchy parts = four_leaves();
  ClickSelection selection(parts, borders_alone());
  selection.apply(stripes(parts, {0, -1, -1, -1}), object(5));
  CHECK(selection.labels() == Labels{1, 1, 0, 0});
  selection.apply(stripes(parts), rest(15));
  CHECK(selection.labels() == Labels{1, 0, 0, 0});
}
