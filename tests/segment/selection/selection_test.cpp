// What clicks mean: by hand on four stripes, invariants and truth on the still life.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/lab/robot_user.h"
#include "core/counter_rng.h"
#include "four_leaves.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/click_selection.h"
#include "segment/selection/stroke_replay.h"
#include "segment/superpoints/orbit.h"
#include "still_life_table.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Labels = std::vector<std::uint8_t>;

// Columns of 10 x 10 pixels, at 10 pixels a unit as leaves of area 1 want it. columns: of leaf -1 show
// nothing.
LeafView stripes(const PartHierarchy& parts, const std::vector<int>& leaf_of_column = {0, 1, 2, 3}) {
  Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, 40, 10);
  camera.fx_px = camera.fy_px = 100;
  Image<std::int32_t> hit(40, 10, -1);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) hit.at(x, y) = leaf_of_column[static_cast<std::size_t>(x / 10)];
  return leaf_view_of_hits(parts, camera, hit);
}

// A model that looks at borders alone.
SelectionModel borders_alone() {
  SelectionModel model;
  const float opposed = weight(&model.later, Term::kOpposed), disc = weight(&model.later, Term::kDisc);
  model.first = model.later = {};
  weight(&model.first, Term::kCut) = weight(&model.later, Term::kCut) = 1;
  weight(&model.later, Term::kOpposed) = opposed;
  weight(&model.later, Term::kDisc) = disc;
  return model;
}

Stroke object(float x) {
  return click({x, 5}, SeedLabel::kObject);
}
Stroke rest(float x) {
  return click({x, 5}, SeedLabel::kRest);
}

Labels selected(const Strokes& strokes, int part_step = 0, const SelectionModel& model = borders_alone()) {
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  ClickSelection selection(parts, model, part_step);
  for (const Stroke& stroke : strokes) selection.apply(view, stroke);
  return selection.labels();
}

bool shows_object(const LeafView& view, const Labels& labels, const glm::vec2& pixel) {
  return shown(view.gaussians, view.camera, labels)
             .at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)) != 0;
}

// Whether the scene covers the pixel at all.
bool covered(const LeafView& view, const glm::vec2& pixel) {
  float sum = 0;
  for (const GroupWeight& w : view.gaussians.at(static_cast<std::size_t>(pixel.y) * view.camera.width_px +
                                                static_cast<std::size_t>(pixel.x)))
    sum += w.weight;
  return sum >= 0.6f;
}

}  // namespace

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

TEST_CASE("selection: one size smaller and larger, beyond the last there is none") {
  for (const auto& [steps, expected] :
       std::map<int, Labels>{{-1, {1, 0, 0, 0}}, {-9, {1, 0, 0, 0}}, {1, {1, 1, 1, 1}}, {9, {1, 1, 1, 1}}})
    CHECK(selected({object(5)}, steps) == expected);
  const PartHierarchy parts = four_leaves();
  ClickSelection selection(parts, borders_alone(), 9);
  selection.apply(stripes(parts), object(5));
  CHECK(selection.sizes() == 3);
  CHECK(selection.size() == 2);
}

TEST_CASE(
    "selection: what is at least half as likely and shows something else is offered, and can be chosen") {
  // Costs by hand: .09 ln(border / size) is -.65 for the pair, -.06 for all four, 0 for the leaf.
  SelectionModel unsure = borders_alone();
  weight(&unsure.first, Term::kCut) = 0.09f;
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const std::vector<Labels> meant = {{1, 1, 0, 0}, {1, 1, 1, 1}, {1, 0, 0, 0}};
  for (const int choice : {0, 1, 2, 9}) {
    CAPTURE(choice);
    ClickSelection selection(parts, unsure, 0, choice);
    CHECK(selection.meanings().empty());
    selection.apply(view, object(5));
    const std::size_t taken = std::min<std::size_t>(static_cast<std::size_t>(choice), 2);
    REQUIRE(selection.meanings().size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(iou(selection.meanings()[i], shown(view.leaves, view.camera, meant[i])) == 1);
    CHECK(selection.choice() == taken);
    CHECK(selection.labels() == meant[taken]);
    CHECK(selection.sizes() == 3);
    CHECK(selection.likeliest_size() == selection.size());
  }
  ClickSelection smaller(parts, unsure, -1, 1);  // one size below all four
  smaller.apply(view, object(5));
  CHECK(smaller.labels() == meant[0]);
  ClickSelection sure(parts, borders_alone());
  sure.apply(view, object(5));
  CHECK(sure.meanings().size() == 1);
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

TEST_CASE("selection: strokes speak of what was seen alone") {
  const Table& t = table();
  const Target mug = target(t, "mug");
  const glm::vec2 at = robot_click(mug.truth, Mask(mug.truth.width(), mug.truth.height()))->points_px.front();
  StrokeReplay replay(t.prepared.parts);
  std::vector<CameraStroke> strokes = {{mug.camera, click(at, SeedLabel::kObject)}};
  const Labels first = replay.replay(t.cloud, strokes, {}).labels();
  auto seen = std::make_shared<Labels>(first);
  for (std::uint8_t& s : *seen) s = s ? 0 : 1;
  strokes.push_back({mug.camera, click(at, SeedLabel::kObject), seen});
  const Labels hidden = replay.replay(t.cloud, strokes, {}).labels();
  const LeafView behind = leaf_view(t.cloud, t.prepared.parts, mug.camera, {}, seen);
  REQUIRE(covered(behind, at));
  CHECK(shows_object(behind, hidden, at));
  CHECK_FALSE(shows_object(behind, first, at));
  strokes.back().seen = nullptr;  // told of the whole it is no news
  CHECK_FALSE(shows_object(behind, replay.replay(t.cloud, strokes, {}).labels(), at));
  CHECK(hidden == [&] {
    StrokeReplay again(t.prepared.parts);
    strokes.back().seen = std::make_shared<Labels>(*seen);  // the same set elsewhere
    return again.replay(t.cloud, strokes, {}).labels();
  }());
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
    ClickSelection selection(parts, model, 1);
    for (const Stroke& stroke : strokes) selection.apply(view, stroke);
    return selection.labels();
  };
  // The border is 5 pixels away: up to e pi 5^2 = 213 pixels may go. Two stripes are 200, three are 300.
  const std::vector<int> two_more = {0, 1, 2, -1}, three_more = {0, 1, 2, 3};
  CHECK(after(two_more, {object(5)}) == Labels{1, 1, 1, 1});
  CHECK(after(two_more, {object(5), rest(15)}) == Labels{1, 0, 0, 0});
  CHECK(after(three_more, {object(5), rest(15)}) == Labels{1, 0, 1, 1});
  // After two object clicks there is no other meaning of the one.
  CHECK(after(two_more, {object(5), object(7), rest(15)}) == Labels{1, 0, 1, 1});
  weight(&model.later, Term::kRepick) = 50;
  CHECK(after(two_more, {object(5), rest(15)}) == Labels{1, 0, 1, 1});
}

TEST_CASE("selection: a click is obeyed though no part is likely, by its disc alone") {
  SelectionModel nothing_likely = borders_alone();
  weight(&nothing_likely.later, Term::kDisc) = -100;
  const Labels labels = selected({object(5), object(25)}, 0, nothing_likely);
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
  LeafView view = leaf_view_of(parts, camera, lists, Image<float>(40, 10, 10.0f));
  for (const bool sizes_known : {false, true}) {
    if (sizes_known) view.alone_px = {100, 100, 100, 100, 1e6f, 10, 10};
    ClickSelection selection(parts, borders_alone());
    selection.apply(view, object(5));
    selection.apply(view, object(25));
    CHECK(shows_object(view, selection.labels(), {25, 5}));
    CHECK(selection.labels()[kWall] == !sizes_known);
    CHECK(selection.labels()[kSplats[1]] == sizes_known);
  }
}

TEST_CASE("selection: a first click's terms of all views, worked out by hand") {
  // The click's view is four stripes of 100 pixels at one depth, each touching the frame. Elsewhere the left
  // pair covers .04 of a picture, free of the frame, with a border of 1.2 sides before something farther.
  PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const auto terms_of_pair = [&] {
    const auto found =
        ClickSelection(parts, borders_alone()).considered(view, {5.5f, 5.5f}, true, {.all_terms = true});
    REQUIRE(found);
    const auto pair = std::ranges::find(found->candidates, 1u, &Candidate::index);
    REQUIRE(pair != found->candidates.end());
    return pair->terms;
  };
  const TermValues here = terms_of_pair();
  CHECK(weight(here, Term::kNoEdge) == doctest::Approx(1));  // ten pairs of pixels, all plain
  CHECK(weight(here, Term::kCropped) == doctest::Approx(1));
  CHECK(weight(here, Term::kFrame) == doctest::Approx(48 / std::sqrt(200.0)));
  CHECK(weight(here, Term::kLarge) == doctest::Approx(std::log(0.5 / 0.35)));
  parts.trees[0].looks.assign(7, {});
  parts.trees[0].looks[4] = {.area = 0.04f, .area_squared = 0.0016f, .side = 0.2f, .border = 1.2f};
  const TermValues all = terms_of_pair();
  const double border_here = 10 / 20.0, side_here = std::sqrt(0.5), frame_here = 48 / 20.0;
  CHECK(weight(all, Term::kNoEdge) == doctest::Approx(border_here / (border_here + 1.2)));
  CHECK(weight(all, Term::kCropped) == doctest::Approx(side_here / (side_here + 0.2)));
  CHECK(weight(all, Term::kFrame) == doctest::Approx(frame_here / (side_here + 0.2)));
  CHECK(weight(all, Term::kLarge) == doctest::Approx(std::log((0.25 + 0.0016) / (0.5 + 0.04) / 0.35)));
  CHECK(weight(all, Term::kSmall) == 0);
}

TEST_CASE("selection: how views elsewhere show a part decides what a first click means") {
  SelectionModel model;
  model.first = {};
  weight(&model.first, Term::kNoEdge) = 1;
  PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const auto labels = [&] {
    ClickSelection selection(parts, model);
    selection.apply(view, object(5));
    return selection.labels();
  };
  CHECK(labels() == Labels{1, 1, 1, 1});  // no border of it is seen, others have plain ones
  parts.trees[0].looks.assign(7, {});
  parts.trees[0].looks[4] = {.area = 0.04f, .side = 0.2f, .border = 1.2f};
  CHECK(labels() == Labels{1, 1, 0, 0});
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

TEST_CASE("selection: the same first click from nearer means the same part") {
  const Table& t = table();
  for (const std::string object : {"mug", "apple", "orange", "pot", "books"}) {
    const Target on = target(t, object);
    const Stroke first = *robot_click(on.truth, Mask(on.camera.width_px, on.camera.height_px));
    const glm::vec2 pixel = first.points_px.front();
    RasterOptions raster;
    raster.depth = true;
    const float depth = rasterize(t.cloud, on.camera, raster)
                            .median_depth.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
    const auto labels_from = [&](const Camera& camera) {
      StrokeReplay replay(t.prepared.parts);
      return replay.replay(t.cloud, std::vector<CameraStroke>{{camera, first}}, {}).labels();
    };
    const Mask as_seen = shown(on.leaves.gaussians, on.camera, labels_from(on.camera));
    for (const float share : {0.6f, 0.4f}) {
      CAPTURE(object);
      CAPTURE(share);
      const Camera nearer = approached(on.camera, on.camera.world_from_pixel(pixel, depth), share);
      CHECK(iou(shown(on.leaves.gaussians, on.camera, labels_from(nearer)), as_seen) >
            0.93);  // the pot with a leaf less; else .99
    }
  }
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

TEST_CASE("selection: soft views sum what the rasteriser draws") {
  const Table& t = table();
  const Target on = target(t, "apple");
  const auto index = std::ranges::find(t.scene.label_name, "apple") - t.scene.label_name.begin();
  Labels labels(t.cloud.size());
  for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = t.label[g] == index;
  const Mask mask = shown(on.leaves.gaussians, on.camera, labels);
  CHECK(iou(mask, on.truth) > 0.995);
  RasterOptions raster;
  raster.colour = false;
  const Image<float> alpha = rasterize(t.cloud, on.camera, raster).alpha;
  double most = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    double sum = 0;
    for (const GroupWeight& w : on.leaves.gaussians.at(i)) sum += w.weight;
    CHECK(sum <= alpha.pixels()[i] + 1e-4);
    most = std::max(most, alpha.pixels()[i] - sum);
  }
  CHECK(most < 0.2);  // what is too faint to be listed
}

TEST_CASE("selection: every click is obeyed, object clicks only add, rest clicks only remove") {
  const Table& t = table();
  const Target on = target(t, "mug");
  CounterRng rng(3, 0);
  int told = 0;
  for (int draw = 0; draw < 8; ++draw) {
    ClickSelection selection(t.prepared.parts, {});
    Labels before(t.cloud.size(), 0);
    for (int i = 0; i < 8; ++i) {
      const bool object = i == 0 || rng.below(2) == 0;
      const glm::vec2 pixel(rng.between(0, 400), rng.between(0, static_cast<float>(on.camera.height_px)));
      const bool heard =
          selection.apply(on.leaves, click(pixel, object ? SeedLabel::kObject : SeedLabel::kRest));
      if (heard && covered(on.leaves, pixel)) {
        ++told;
        CHECK(shows_object(on.leaves, selection.labels(), pixel) == object);
      }
      bool monotone = true;
      for (std::size_t g = 0; g < before.size(); ++g)
        monotone &= object ? selection.labels()[g] >= before[g] : selection.labels()[g] <= before[g];
      CHECK(monotone);
      before = selection.labels();
    }
  }
  CHECK(told > 40);
}

TEST_CASE("selection: objects of the still life in three robot clicks") {
  const Table& t = table();
  double first = 0, third = 0;
  const std::vector<std::string> objects = {"mug", "apple", "orange", "plant", "pot", "books"};
  for (const std::string& object : objects) {
    const Target on = target(t, object);
    ClickSelection selection(t.prepared.parts, {});
    std::vector<double> ious;
    Mask mask(on.camera.width_px, on.camera.height_px);
    for (int i = 0; i < 3; ++i) {
      if (const auto next = robot_click(on.truth, mask)) selection.apply(on.leaves, *next);
      mask = shown(on.leaves.gaussians, on.camera, selection.labels());
      ious.push_back(iou(mask, on.truth));
    }
    MESSAGE(object, " ", ious[0], " ", ious[1], " ", ious[2]);
    first += ious[0] / static_cast<double>(objects.size());
    third += ious[2] / static_cast<double>(objects.size());
  }
  CHECK(first > 0.7);
  CHECK(third > 0.93);
}

TEST_CASE("selection: replayed strokes give what strokes one by one give, on any number of threads") {
  const Table& t = table();
  const Target apple = target(t, "apple"), mug = target(t, "mug");
  const auto said = [](const Target& on, float x, float y, SeedLabel label) {
    return CameraStroke{on.camera, click({x, y}, label)};
  };
  const std::vector<CameraStroke> strokes = {
      said(mug, 30, 200, SeedLabel::kRest), said(apple, 200, 150, SeedLabel::kObject),
      said(mug, 150, 120, SeedLabel::kObject), said(apple, 60, 60, SeedLabel::kRest)};
  StrokeReplay once(t.prepared.parts), growing(t.prepared.parts);
  const Labels all = once.replay(t.cloud, strokes, {}).labels();
  Labels grown;
  for (std::size_t n = 2; n <= strokes.size(); ++n)
    grown = growing.replay(t.cloud, std::span(strokes).first(n), {}).labels();
  CHECK(grown == all);
  growing.replay(t.cloud, std::span(strokes).first(2), {});  // undone
  std::stop_source stop;
  stop.request_stop();
  StrokeReplay stopped(t.prepared.parts);
  stopped.replay(t.cloud, strokes, {}, {.stop = stop.get_token(), .on_progress = {}});
  CHECK(stopped.replay(t.cloud, strokes, {}).labels() == all);  // nothing half made is kept
  CHECK(growing.replay(t.cloud, strokes, {}).labels() == all);
  tbb::task_arena(1).execute([&] {
    StrokeReplay alone(t.prepared.parts);
    CHECK(alone.replay(t.cloud, strokes, {}).labels() == all);
  });
}
