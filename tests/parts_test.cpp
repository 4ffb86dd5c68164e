// The hierarchy of parts and what clicks mean in it: by hand on small ones, against truth on the still life.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/lab/robot_user.h"
#include "scene/counter_rng.h"
#include "scene/rasterizer.h"
#include "segment/mask_tools.h"
#include "segment/part_picker.h"
#include "segment/prepared_scene.h"
#include "segment/session/session.h"
#include "still_life_table.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Two flat squares of one colour each in the plane z = 0, `gap` apart along x.
GaussianCloud two_squares(float gap, const glm::vec3& left, const glm::vec3& right) {
  constexpr int kSide = 30;
  GaussianCloud cloud;
  cloud.resize(2 * kSide * kSide, 0);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const std::size_t square = g / (kSide * kSide), i = g % (kSide * kSide);
    const float x = 0.1f * static_cast<float>(i % kSide), y = 0.1f * static_cast<float>(i / kSide);
    cloud.position[g] = {x + (square ? 3.0f + gap : 0.0f), y, 0};
    cloud.scale[g] = {0.05f, 0.05f, 0.005f};
    cloud.opacity[g] = 0.95f;
    cloud.f_dc[g] = square ? right : left;
    cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  return cloud;
}

const std::span<const Camera> kNoViews;

PartOptions one_tree() {
  PartOptions options;
  options.trees = 1;
  return options;
}

// Four leaves in a row of a 40 x 10 picture, 10 pixels wide each: ((0 1) (2 3)).
PartHierarchy four_leaves() {
  PartHierarchy parts;
  parts.leaves = 4;
  parts.leaf_of = {0, 1, 2, 3};
  PartTree tree;
  tree.parent = {4, 4, 5, 5, 6, 6, kNoPart};
  const std::array<std::uint32_t, 2> leaf{kNoPart, kNoPart};
  tree.children = {leaf, leaf, leaf, leaf, {0, 1}, {2, 3}, {4, 5}};
  tree.area = {1, 1, 1, 1, 2, 2, 4};
  tree.cut = {1, 1, 1, 1, 0.001f, 0.001f, 1};
  tree.merge_cost = {0, 0, 0, 0, 0.1f, 0.1f, 10};
  parts.trees = {tree};
  return parts;
}

Image<std::int32_t> four_stripes() {
  Image<std::int32_t> hit(40, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) hit.at(x, y) = x / 10;
  return hit;
}

// Mask IoU after each of n robot clicks.
std::vector<double> robot_ious(const Table& t, const Target& target, int n) {
  Mask mask(target.truth.width(), target.truth.height());
  Strokes strokes;
  std::vector<double> ious;
  for (int i = 0; i < n; ++i) {
    if (const auto next = robot_click(target.truth, mask)) {
      strokes.push_back(*next);
      mask = mask_of(target.view, pick_parts(t.prepared.parts, target.view, strokes).leaves);
    }
    ious.push_back(iou(mask, target.truth));
  }
  return ious;
}

}  // namespace

TEST_CASE("parts: leaves keep to one colour, the two squares are two parts of the tree") {
  const GaussianCloud cloud = two_squares(0.1f, {1, -1, -1}, {-1, -1, 1});
  const PartHierarchy parts = build_part_hierarchy(cloud, kNoViews, one_tree());
  REQUIRE(parts.trees.size() == 1);
  const PartTree& tree = parts.trees[0];
  std::vector<int> left(tree.nodes(), 0), right(tree.nodes(), 0);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    REQUIRE(parts.leaf_of[g] < parts.leaves);
    ++(g < cloud.size() / 2 ? left : right)[parts.leaf_of[g]];
  }
  for (std::uint32_t leaf = 0; leaf < parts.leaves; ++leaf) CHECK((left[leaf] == 0 || right[leaf] == 0));
  for (std::size_t n = 0; n < tree.nodes(); ++n)
    if (tree.parent[n] != kNoPart) {
      left[tree.parent[n]] += left[n];
      right[tree.parent[n]] += right[n];
    }
  const int half = static_cast<int>(cloud.size() / 2);
  bool found_left = false, found_right = false;
  for (std::size_t n = 0; n < tree.nodes(); ++n) {
    found_left |= left[n] == half && right[n] == 0;
    found_right |= right[n] == half && left[n] == 0;
  }
  CHECK(found_left);
  CHECK(found_right);
}

TEST_CASE("parts: children come first, areas add up, one root per connected piece, in every tree") {
  for (const auto& [gap, roots] : std::map<float, int>{{0.1f, 1}, {50.0f, 2}}) {
    const PartHierarchy parts = build_part_hierarchy(two_squares(gap, {1, 0, 0}, {0, 0, 1}), kNoViews);
    REQUIRE(parts.trees.size() == 5);
    for (const PartTree& tree : parts.trees) {
      CHECK(std::ranges::count(tree.parent, kNoPart) == roots);
      REQUIRE(tree.nodes() == 2 * parts.leaves - static_cast<std::size_t>(roots));
      for (std::uint32_t n = 0; n < tree.nodes(); ++n) {
        const auto [a, b] = tree.children[n];
        if (n < parts.leaves) {
          CHECK(a == kNoPart);
          continue;
        }
        CHECK(std::max(a, b) < n);
        CHECK(tree.parent[a] == n);
        CHECK(tree.parent[b] == n);
        CHECK(tree.area[n] == doctest::Approx(tree.area[a] + tree.area[b]));
      }
      // The squares' area: 2 x 3 x 3 scene units, a little less for their rims.
      double area = 0;
      for (std::uint32_t n = 0; n < parts.leaves; ++n) area += tree.area[n];
      CHECK(area == doctest::Approx(18).epsilon(0.25));
    }
  }
}

TEST_CASE("parts: a cloud without surface has no part, and clicks there do nothing") {
  GaussianCloud cloud = two_squares(0.1f, {1, 0, 0}, {0, 0, 1});
  std::ranges::fill(cloud.opacity, 0.01f);
  for (const GaussianCloud& c : {cloud, GaussianCloud()}) {
    const PartHierarchy parts = build_part_hierarchy(c, kNoViews);
    CHECK(parts.leaves == 0);
    CHECK(std::ranges::all_of(parts.leaf_of, [](std::uint32_t l) { return l == kNoPart; }));
    const PartView view = view_parts(parts, Image<std::int32_t>(8, 8, -1));
    CHECK(pick_parts(parts, view, {click({4, 4}, SeedLabel::kObject)}).leaves.empty());
  }
}

TEST_CASE("parts: the same hierarchy on 1, 2, 3 threads") {
  const GaussianCloud cloud = random_cloud(4000, 5);
  const PartHierarchy parts = build_part_hierarchy(cloud, kNoViews);
  for (const int threads : {1, 2, 3})
    tbb::task_arena(threads).execute([&] {
      const PartHierarchy again = build_part_hierarchy(cloud, kNoViews);
      CHECK(again.leaf_of == parts.leaf_of);
      for (std::size_t t = 0; t < parts.trees.size(); ++t) {
        CHECK(again.trees[t].parent == parts.trees[t].parent);
        CHECK(again.trees[t].cut == parts.trees[t].cut);
      }
    });
}

TEST_CASE("parts: pixels of a view add up along the tree, the frame's are counted apart") {
  const PartView view = view_parts(four_leaves(), four_stripes());
  CHECK(view.trees[0].pixels == std::vector<float>{100, 100, 100, 100, 200, 200, 400});
  CHECK(view.trees[0].frame_pixels == std::vector<float>{28, 20, 20, 28, 48, 48, 96});
}

TEST_CASE("parts: clicks on four stripes, worked out by hand") {
  const PartHierarchy parts = four_leaves();
  const PartView view = view_parts(parts, four_stripes());
  PickOptions options;
  options.cut_weight = 1;
  options.jump_bonus = options.rise_bonus = options.frame_penalty = options.small_penalty =
      options.large_penalty = 0;
  using Leaves = std::vector<std::uint8_t>;
  const auto leaves = [&](const Strokes& strokes) {
    return pick_parts(parts, view, strokes, options).leaves;
  };
  const auto object = [](float x) { return click({x, 5}, SeedLabel::kObject); };
  const auto rest = [](float x) { return click({x, 5}, SeedLabel::kRest); };
  // The pair has the least border for its size: ln(0.001 / sqrt 2) against ln 1 of a leaf.
  CHECK(leaves({object(5)}) == Leaves{1, 1, 0, 0});
  CHECK(leaves({object(35)}) == Leaves{0, 0, 1, 1});
  CHECK(leaves({object(5), object(25)}) == Leaves{1, 1, 1, 1});
  // Removes what it hits, but nothing that holds the object click.
  CHECK(leaves({object(5), rest(15)}) == Leaves{1, 0, 0, 0});
  // Told first it says the same: all four are meant, and one is not. It keeps no part from being meant.
  options.scale_steps = 1;
  CHECK(leaves({object(5), rest(15)}) == Leaves{1, 0, 1, 1});
  CHECK(leaves({rest(15), object(5)}) == Leaves{1, 0, 1, 1});
  CHECK(leaves({rest(35), rest(25), object(5)}) == leaves({object(5), rest(35), rest(25)}));
  CHECK(leaves({rest(35)}) == Leaves{0, 0, 0, 0});
  options.scale_steps = 0;
  CHECK(leaves({object(5), object(7)}) == Leaves{1, 1, 0, 0});
  // One size smaller and larger; beyond the last there is none.
  for (const auto& [steps, expected] :
       std::map<int, Leaves>{{-1, {1, 0, 0, 0}}, {-9, {1, 0, 0, 0}}, {1, {1, 1, 1, 1}}, {9, {1, 1, 1, 1}}}) {
    options.scale_steps = steps;
    CHECK(leaves({object(5)}) == expected);
  }
  options.scale_steps = 0;
  const Pick pick = pick_parts(parts, view, {object(5)}, options);
  CHECK(pick.first_chain.size() == 3);
  CHECK(pick.first_chosen == 1);
  CHECK_FALSE(pick.ambiguous);
  CHECK(labels_of(parts, pick.leaves) == Leaves{1, 1, 0, 0});
  CHECK(count(mask_of(view, pick.leaves)) == 200);
}

TEST_CASE(
    "parts: an object click just beside what is selected is not lost, a rest click just inside takes no more "
    "than it means") {
  const PartHierarchy parts = four_leaves();
  const PartView view = view_parts(parts, four_stripes());
  PickOptions options;
  options.scale_steps = -10;  // the first click takes its leaf alone
  using Leaves = std::vector<std::uint8_t>;
  const auto leaves = [&](float x) {
    return pick_parts(parts, view, {click({5, 5}, SeedLabel::kObject), click({x, 5}, SeedLabel::kObject)},
                      options)
        .leaves;
  };
  CHECK(leaves(12.5f) == Leaves{1, 1, 0, 0});
  // At the very border, a stripe of a hundred pixels looks like a slip.
  CHECK(leaves(10.5f) == Leaves{1, 0, 0, 0});
  options.border_px = 0;
  CHECK(leaves(10.5f) == Leaves{1, 1, 0, 0});
  options.change_most_of_selected = 0;
  CHECK(leaves(10.5f) == Leaves{1, 0, 0, 0});
  const Strokes slip = {click({5, 5}, SeedLabel::kObject), click({9, 5}, SeedLabel::kRest)};
  PickOptions leaf_alone;
  leaf_alone.scale_steps = -10;
  CHECK(pick_parts(parts, view, slip, leaf_alone).leaves == std::vector<std::uint8_t>{1, 0, 0, 0});
}

TEST_CASE("parts: a correction that brings much of what the view hides is not meant") {
  PartHierarchy parts = four_leaves();
  const PartView view = view_parts(parts, four_stripes());
  parts.trees[0].cut = {1, 1, 1, 1, 1, 0.5f, 1};  // the right pair looks a little likelier than its stripes
  PickOptions options;
  options.cut_weight = 1;
  options.jump_bonus = options.rise_bonus = options.frame_penalty = options.small_penalty =
      options.large_penalty = 0;
  options.joint_bonus = 0;
  options.scale_steps = -10;
  const Strokes strokes = {click({5, 5}, SeedLabel::kObject), click({25, 5}, SeedLabel::kObject)};
  using Leaves = std::vector<std::uint8_t>;
  CHECK(pick_parts(parts, view, strokes, options).leaves == Leaves{1, 0, 1, 1});
  parts.trees[0].area = {1, 1, 1, 99, 2, 100, 102};  // the last stripe is the tip of something large
  options.hidden_penalty = 0;
  CHECK(pick_parts(parts, view, strokes, options).leaves == Leaves{1, 0, 1, 1});
  options.hidden_penalty = 2;
  CHECK(pick_parts(parts, view, strokes, options).leaves == Leaves{1, 0, 1, 0});
}

TEST_CASE("parts: a part that holds all object clicks is likelier meant than one that holds the last alone") {
  PartHierarchy parts = four_leaves();
  const PartView view = view_parts(parts, four_stripes());
  parts.trees[0].cut = {
      1, 1, 1,   1,
      2, 2, 2.5f};  // the whole looks a little less likely than a stripe: ln(2.5 / 2) against ln 1
  PickOptions options;
  options.cut_weight = 1;
  options.jump_bonus = options.rise_bonus = options.frame_penalty = options.small_penalty =
      options.large_penalty = options.change_small = 0;
  options.scale_steps = -10;  // the first click takes its stripe
  const Strokes strokes = {click({5, 5}, SeedLabel::kObject), click({25, 5}, SeedLabel::kObject)};
  using Leaves = std::vector<std::uint8_t>;
  CHECK(pick_parts(parts, view, strokes, options).leaves == Leaves{1, 1, 1, 1});
  options.joint_bonus = 0;
  CHECK(pick_parts(parts, view, strokes, options).leaves == Leaves{1, 0, 1, 0});
  options.joint_bonus = 1;
  Strokes with_rest = strokes;
  with_rest.insert(with_rest.begin() + 1, click({35, 5}, SeedLabel::kRest));
  CHECK(pick_parts(parts, view, with_rest, options).leaves == Leaves{1, 0, 1, 0});
}

TEST_CASE("parts: from the third object click on, a part much larger than what is selected is not meant") {
  PartHierarchy parts = four_leaves();
  const PartView view = view_parts(parts, four_stripes());
  parts.trees[0].cut = {1, 1, 1, 1, 2, 2, 2};
  PickOptions options;
  options.jump_bonus = options.rise_bonus = options.frame_penalty = options.small_penalty =
      options.large_penalty = options.change_small = 0;
  options.scale_steps = -10;
  const Strokes two = {click({5, 5}, SeedLabel::kObject), click({25, 5}, SeedLabel::kObject)};
  Strokes three = two;
  three.insert(three.begin() + 1, click({6, 5}, SeedLabel::kObject));  // on what is selected
  using Leaves = std::vector<std::uint8_t>;
  options.late_growth_penalty = 5;  // ln 3 of the whole against a slack of ln 2
  CHECK(pick_parts(parts, view, two, options).leaves == Leaves{1, 1, 1, 1});
  CHECK(pick_parts(parts, view, three, options).leaves == Leaves{1, 0, 1, 0});
  options.late_growth_penalty = 0;
  CHECK(pick_parts(parts, view, three, options).leaves == Leaves{1, 1, 1, 1});
}

TEST_CASE("parts: a mask of one side completes to whole nodes, by hand") {
  const PartHierarchy parts = four_leaves();
  Image<std::int32_t> hit = four_stripes();
  for (auto& h : hit.pixels())
    if (h == 1) h = 0;  // leaf 1 is hidden
  const PartView view = view_parts(parts, hit);
  Mask mask(40, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) mask.at(x, y) = kMaskObject;
  CHECK(parts_of_mask(parts, view, mask) == std::vector<std::uint8_t>{1, 1, 0, 0});
  // Five of the next leaf's hundred pixels more do not take it in, half of the pair's less do not keep it.
  for (int x = 20; x < 25; ++x) mask.at(x, 0) = kMaskObject;
  CHECK(parts_of_mask(parts, view, mask) == std::vector<std::uint8_t>{1, 1, 0, 0});
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 15; ++x) mask.at(x, y) = 0;
  CHECK(parts_of_mask(parts, view, mask) == std::vector<std::uint8_t>{0, 0, 0, 0});
}

TEST_CASE("parts: the true mask of one view selects the whole object of the still life") {
  const Table& t = table();
  for (const std::string object : {"apple", "pot", "books"}) {
    const Target on = target(t, object);
    const auto index = std::ranges::find(t.scene.label_name, object) - t.scene.label_name.begin();
    const std::vector<std::uint8_t> labels =
        labels_of(t.prepared.parts, parts_of_mask(t.prepared.parts, on.view, on.truth));
    double both = 0, either = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) {
      both += labels[g] && t.label[g] == index;
      either += labels[g] || t.label[g] == index;
    }
    MESSAGE(object, " ", both / either);
    CHECK(both / either > 0.8);
  }
}

TEST_CASE("parts: object clicks only add, rest clicks only remove, wherever they go") {
  const Table& t = table();
  const Target on = target(t, "mug");
  CounterRng rng(3, 0);
  for (int draw = 0; draw < 20; ++draw) {
    Strokes strokes;
    std::vector<std::uint8_t> before(t.prepared.parts.leaves, 0);
    for (int i = 0; i < 8; ++i) {
      const bool object = i == 0 || rng.below(2) == 0;
      strokes.push_back(click({rng.between(0, 400), rng.between(0, static_cast<float>(on.camera.height_px))},
                              object ? SeedLabel::kObject : SeedLabel::kRest));
      const std::vector<std::uint8_t> after = pick_parts(t.prepared.parts, on.view, strokes).leaves;
      bool monotone = true;
      for (std::size_t l = 0; l < after.size(); ++l)
        monotone &= object ? after[l] >= before[l] : after[l] <= before[l];
      CHECK(monotone);
      before = after;
    }
  }
}

TEST_CASE("parts: objects of the still life in three robot clicks") {
  const Table& t = table();
  double first = 0, third = 0;
  const std::vector<std::string> objects = {"mug", "apple", "orange", "plant", "pot", "books"};
  for (const std::string& object : objects) {
    const std::vector<double> ious = robot_ious(t, target(t, object), 3);
    MESSAGE(object, " ", ious[0], " ", ious[1], " ", ious[2]);
    first += ious[0] / static_cast<double>(objects.size());
    third += ious[2] / static_cast<double>(objects.size());
  }
  CHECK(first > 0.7);
  CHECK(third > 0.93);
}

TEST_CASE("parts: cancelled before, or at any step that reports progress, without harm") {
  const GaussianCloud cloud = random_cloud(3000, 8);
  const Camera camera = look_at({0, 0, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120);
  for (int step = 0; step < 12; ++step) {
    std::stop_source stop;
    int seen = 0;
    Job job;
    job.stop = stop.get_token();
    job.on_progress = [&](std::string_view, double) {
      if (seen++ == step) stop.request_stop();
    };
    prepare_scene(cloud, camera, {0, -1, 0}, {}, {}, job);
  }
  std::stop_source stopped;
  stopped.request_stop();
  Job job;
  job.stop = stopped.get_token();
  CHECK(prepare_scene(cloud, camera, {0, -1, 0}, {}, {}, job).parts.trees.empty());
  const auto prepared = std::make_shared<const PreparedScene>(prepare_scene(cloud, camera, {0, -1, 0}, {}));
  Session session({{std::shared_ptr<void>(), &cloud}, prepared, {0, -1, 0}, {}});
  CutRequest request;
  request.strokes = {{camera, {click({80, 60}, SeedLabel::kObject)}}};
  const Mask none = session.first_mask(request, preset("default"), job);
  CHECK(none.width() == 160);
  CHECK(count(none) == 0);
}

TEST_CASE("parts: a scene prepared for masks from pixels has none") {
  CutSettings options = preset("default");
  CHECK(prepare_options(options).with_parts);
  options.first_mask_from = FirstMaskFrom::kPixels;
  const GaussianCloud cloud = random_cloud(1000, 8);
  const Camera camera = look_at({0, 0, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120);
  const PreparedScene prepared = prepare_scene(cloud, camera, {0, -1, 0}, {}, prepare_options(options));
  CHECK(prepared.parts.trees.empty());
  CHECK(prepared.graph.nodes() == cloud.size());
}
