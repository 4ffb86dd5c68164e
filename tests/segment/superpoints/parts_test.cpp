// The hierarchy of parts: by hand on small ones, against truth on the still life.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "core/counter_rng.h"
#include "four_leaves.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/click_selection.h"
#include "segment/session/session.h"
#include "segment/superpoints/part_view.h"
#include "segment/superpoints/prepared_scene.h"
#include "segment/superpoints/superpoints.h"
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
  options.shade_blind_trees = 0;
  return options;
}

// One leaf after the other in a row, 10 x 10 pixels each.
Image<std::int32_t> four_stripes() {
  Image<std::int32_t> hit(40, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) hit.at(x, y) = x / 10;
  return hit;
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

TEST_CASE("parts: what is least unlike joins first, also where rounding leaves less than nothing") {
  SurfaceFeatures three;
  three.core = {0, 1, 2};
  SurfaceEdge copies{0, 1}, others{1, 2};
  copies.normal = -1.2e-7f;  // 1 - n.n of a unit vector as floats have it
  others.colour = 0.01f;
  SuperpointOptions pairs;
  pairs.cap = 2;
  pairs.least = 1;
  const Superpoints found = superpoints(three, std::vector{copies, others}, pairs);
  CHECK(found.of[0] == found.of[1]);
  CHECK(found.of[1] != found.of[2]);
}

TEST_CASE("parts: children come first, areas add up, one root per connected piece, in every tree") {
  for (const auto& [gap, roots] : std::map<float, int>{{0.1f, 1}, {50.0f, 2}}) {
    const PartHierarchy parts = build_part_hierarchy(two_squares(gap, {1, 0, 0}, {0, 0, 1}), kNoViews);
    REQUIRE(parts.plain_trees == 5);
    REQUIRE(parts.trees.size() == 8);
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
    const Camera camera = look_at({0, 0, -1}, {0, 0, 0}, {0, -1, 0}, 1, 8, 8);
    const LeafView view = leaf_view_of_hits(parts, camera, Image<std::int32_t>(8, 8, -1));
    ClickSelection selection(parts, {});
    CHECK_FALSE(selection.apply(view, click({4, 4}, SeedLabel::kObject)));
    CHECK(std::ranges::none_of(selection.labels(), [](std::uint8_t l) { return l != 0; }));
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

TEST_CASE("parts: pixels of a view add up along the tree") {
  const PartView view = view_parts(four_leaves(), four_stripes());
  CHECK(view.trees[0].pixels == std::vector<float>{100, 100, 100, 100, 200, 200, 400});
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

TEST_CASE("parts: cancelled before, or at any step that reports progress, without harm") {
  const GaussianCloud cloud = random_cloud(3000, 8);
  const Camera camera = look_at({0, 0, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120);
  const PreparedScene whole = prepare_scene(cloud, observing_views(cloud, camera, {0, -1, 0}, {}));
  REQUIRE_FALSE(whole.parts.trees.empty());
  // Stopped at its step-th report of progress, if there are so many.
  const auto stopped_at = [&](int step, int* reports) {
    std::stop_source stop;
    Job job;
    job.stop = stop.get_token();
    std::atomic<int> seen = 0;  // reports may come from workers
    job.on_progress = [&](std::string_view, double) {
      if (seen++ == step) stop.request_stop();
    };
    const PreparedScene made =
        prepare_scene(cloud, observing_views(cloud, camera, {0, -1, 0}, {}, {}, job), {}, job);
    *reports = seen;
    return made.parts.trees.size();
  };
  int all = 0;
  constexpr int kNever = -1;
  CHECK(stopped_at(kNever, &all) == whole.parts.trees.size());
  REQUIRE(all > 2);
  int stopped_with_none = 0;
  for (int step = 0; step < all; ++step) {
    CAPTURE(step);
    int reports = 0;
    const std::size_t trees = stopped_at(step, &reports);
    CHECK(reports > step);                                     // it was reached
    CHECK((trees == 0 || trees == whole.parts.trees.size()));  // no half
    stopped_with_none += trees == 0;
  }
  CHECK(stopped_with_none > 0);  // a late stop finds all trees grown
  std::stop_source stopped;
  stopped.request_stop();
  Job job;
  job.stop = stopped.get_token();
  CHECK(prepare_scene(cloud, observing_views(cloud, camera, {0, -1, 0}, {}, {}, job), {}, job)
            .parts.trees.empty());
  Session session({.cloud = {std::shared_ptr<void>(), &cloud}});
  CutRequest request;
  request.strokes = {{camera, {click({80, 60}, SeedLabel::kObject)}}};
  CHECK(count(session.first_mask(request, preset("default"), job)) == 0);
  CHECK(session.neighbourhoods() == 0);
}
