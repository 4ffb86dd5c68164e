#include "segment/superpoints/part_looks.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <set>

#include "four_leaves.h"
#include "scene/raster/depth_jump.h"
#include "scene/raster/rasterizer.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

namespace {

// A tree over so many leaves that joins two random roots at a time.
PartTree random_tree(std::uint32_t leaves, std::mt19937& random) {
  PartTree tree;
  tree.parent.assign(leaves, kNoPart);
  std::vector<std::uint32_t> roots(leaves);
  for (std::uint32_t l = 0; l < leaves; ++l) roots[l] = l;
  while (roots.size() > 2) {  // two roots stay: a forest
    const auto node = static_cast<std::uint32_t>(tree.parent.size());
    for (int child = 0; child < 2; ++child) {
      const std::size_t i = random() % roots.size();
      tree.parent[roots[i]] = node;
      roots.erase(roots.begin() + static_cast<std::ptrdiff_t>(i));
    }
    tree.parent.push_back(kNoPart);
    roots.push_back(node);
  }
  return tree;
}

std::set<std::uint32_t> leaves_of(const PartTree& tree, std::uint32_t leaves, std::uint32_t node) {
  std::set<std::uint32_t> held;
  for (std::uint32_t l = 0; l < leaves; ++l)
    for (std::uint32_t up = l; up != kNoPart; up = tree.parent[up])
      if (up == node) held.insert(l);
  return held;
}

// Counted pixel by pixel, for one node alone.
PartLooks counted(const std::set<std::uint32_t>& held, const LeafPicture& picture) {
  const int width = picture.leaf.width(), height = picture.leaf.height();
  const auto holds = [&](int x, int y) { return held.contains(picture.leaf.at(x, y)); };
  int area = 0, frame = 0, border = 0, plain = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      area += holds(x, y);
      frame += holds(x, y) && (x == 0 || y == 0 || x == width - 1 || y == height - 1);
      for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
        const glm::ivec2 p(x, y), q = p + step;
        if (q.x == width || q.y == height || holds(p.x, p.y) == holds(q.x, q.y)) continue;
        ++border;
        plain += !depth_jumps(picture.depth, p - step, q + step, kJumpAtBorderOfPart);
      }
    }
  const double all = width * height, share = area / all, side = std::sqrt(all);
  const auto f = [](double value) { return static_cast<float>(value); };
  return {f(share),        f(share * share), f(std::sqrt(share)), f(frame ? std::sqrt(share) : 0),
          f(frame / side), f(border / side), f(plain / side)};
}

bool alike(const PartLooks& a, const PartLooks& b) {
  const auto near = [](float x, float y) { return x == doctest::Approx(y).epsilon(1e-5); };
  return near(a.area, b.area) && near(a.area_squared, b.area_squared) && near(a.side, b.side) &&
         near(a.cropped_side, b.cropped_side) && near(a.frame, b.frame) && near(a.border, b.border) &&
         near(a.plain_border, b.plain_border);
}

}  // namespace

TEST_CASE("part looks: two stripes before nothing, worked out by hand") {
  // Leaf 0 in columns 0 and 1, leaf 1 in 2 and 3, nothing in 4 and 5; four rows, both 10 units away.
  LeafPicture picture{Image<std::uint32_t>(6, 4, kNoPart), Image<float>(6, 4, 0.0f)};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      picture.leaf.at(x, y) = x < 2 ? 0 : 1;
      picture.depth.at(x, y) = 10;
    }
  const auto looks = looks_in(testing::four_leaves(), picture);
  REQUIRE(looks.size() == 1);
  const double pixel = 1 / std::sqrt(24.0);
  const PartLooks& leaf = looks[0][1];
  CHECK(leaf.area == doctest::Approx(8 / 24.0));
  CHECK(leaf.frame == doctest::Approx(4 * pixel));
  CHECK(leaf.border == doctest::Approx(8 * pixel));        // four pairs towards leaf 0 of the same depth,
  CHECK(leaf.plain_border == doctest::Approx(4 * pixel));  // and four towards nothing
  const PartLooks& pair = looks[0][4];
  CHECK(pair.area == doctest::Approx(16 / 24.0));
  CHECK(pair.frame == doctest::Approx(10 * pixel));
  CHECK(pair.border == doctest::Approx(4 * pixel));
  CHECK(pair.plain_border == 0);
  CHECK(pair.area_squared == doctest::Approx(16 / 24.0 * 16 / 24.0));
  CHECK(pair.side == doctest::Approx(std::sqrt(16 / 24.0)));
  CHECK(pair.cropped_side == pair.side);
  CHECK(looks[0][5] == PartLooks{});
  CHECK(looks[0][6] == pair);
}

TEST_CASE("part looks: random pictures and trees as counted pixel by pixel") {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    PartHierarchy parts;
    parts.leaves = static_cast<std::uint32_t>(2 + random() % 9);
    parts.trees = {random_tree(parts.leaves, random), random_tree(parts.leaves, random)};
    LeafPicture picture{Image<std::uint32_t>(11, 7), Image<float>(11, 7)};
    for (std::size_t i = 0; i < picture.leaf.size(); ++i) {
      const auto leaf = static_cast<std::uint32_t>(random() % (parts.leaves + 1));
      picture.leaf.pixels()[i] = leaf == parts.leaves ? kNoPart : leaf;
      picture.depth.pixels()[i] = leaf == parts.leaves ? 0 : 5 + 0.1f * static_cast<float>(random() % 9);
    }
    const auto looks = looks_in(parts, picture);
    for (std::size_t t = 0; t < 2; ++t)
      for (std::uint32_t node = 0; node < parts.trees[t].nodes(); ++node) {
        CAPTURE(round);
        CAPTURE(node);
        CHECK(alike(looks[t][node], counted(leaves_of(parts.trees[t], parts.leaves, node), picture)));
      }
  }
}

TEST_CASE("part looks: a jump of depth") {
  Image<float> depth(3, 1, 0.0f);
  depth.at(0, 0) = 2;
  depth.at(1, 0) = 4;
  for (const float factor : {1.01f, 1.99f, 2.0f, 2.01f}) {
    CHECK(depth_jumps(depth, {0, 0}, {1, 0}, factor) == (factor < 2));
    CHECK(depth_jumps(depth, {1, 0}, {0, 0}, factor) == (factor < 2));
  }
  CHECK(depth_jumps(depth, {2, 0}, {1, 0}, 1e30f));         // nothing beside something
  CHECK_FALSE(depth_jumps(depth, {2, 0}, {9, 0}, 1.001f));  // outside, the frame's pixel counts
  CHECK_FALSE(depth_jumps(depth, {-5, 0}, {0, 3}, 1.001f));
}

TEST_CASE("part looks: a pixel is the leaf's that makes most of it, if anything does") {
  using List = std::vector<GroupWeight>;
  CHECK(group_of_pixel(List{{7, 0.4f}, {3, 0.2f}}) == 7);
  CHECK(group_of_pixel(List{{7, 0.3f}, {3, 0.1f}}) == kNoPart);
  CHECK(group_of_pixel(List{}) == kNoPart);
}

}  // namespace splatcut
