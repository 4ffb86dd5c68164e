// Sizes of what a first stroke takes: by hand on two trees, by what must hold on random ones, and of a box.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "four_stripes.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/part_sizes.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Tree 0 pairs leaves 0 with 1 and 2 with 3; tree 1 pairs 0 with 2 and 1 with 3. Nodes 4, 5 are the pairs.
PartHierarchy two_trees() {
  PartHierarchy parts = four_leaves();
  parts.trees.resize(1);
  parts.trees.push_back(parts.trees.front());
  parts.trees[1].parent = {4, 5, 4, 5, 6, 6, kNoPart};
  parts.trees[1].children = {{{kNoPart, kNoPart},
                              {kNoPart, kNoPart},
                              {kNoPart, kNoPart},
                              {kNoPart, kNoPart},
                              {0, 2},
                              {1, 3},
                              {4, 5}}};
  return parts;
}

PartMeaning part(std::uint32_t tree, std::uint32_t node, float cost) {
  return {.tree = tree, .node = node, .terms = {}, .cost = cost};
}

std::vector<Labels> all_sizes(const PartSizes& sizes) {
  std::vector<Labels> all;
  for (std::size_t s = 0; s < sizes.count; ++s) all.push_back(sizes.leaves(s));
  return all;
}

}  // namespace

TEST_CASE("sizes: the next one is the cheapest of its kind in any tree") {
  const PartHierarchy parts = two_trees();
  const std::vector<float> px(4, 100);
  std::vector<PartMeaning> meanings = {part(0, 0, 0), part(0, 4, 2), part(1, 4, 1), part(0, 6, 5)};
  const PartSizes sizes = part_sizes(parts, Labels{1, 0, 0, 0}, meanings, px);
  CHECK(sizes.taken == 0);
  CHECK(all_sizes(sizes) == std::vector<Labels>{{1, 0, 0, 0}, {1, 0, 1, 0}, {1, 1, 1, 1}});
  meanings[1].cost = 0.5f;
  CHECK(part_sizes(parts, Labels{1, 0, 0, 0}, meanings, px).leaves(1) == Labels{1, 1, 0, 0});
  // From the pair downwards; a cheaper leaf of the other pair is outside of it.
  meanings.push_back(part(0, 2, -9));
  const PartSizes down = part_sizes(parts, Labels{1, 1, 0, 0}, meanings, px);
  CHECK(down.taken == 1);
  CHECK(all_sizes(down) == std::vector<Labels>{{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 1, 1, 1}});
}

TEST_CASE("sizes: a part of another tree is joined with the size that it nearly holds") {
  const PartHierarchy parts = two_trees();
  const std::vector<float> px = {100, 5, 60, 100};
  const std::vector<PartMeaning> meanings = {part(0, 0, 0), part(0, 4, 1), part(1, 4, 1)};
  const PartSizes sizes = part_sizes(parts, Labels{1, 1, 0, 0}, meanings, px);
  CHECK(all_sizes(sizes) == std::vector<Labels>{{1, 1, 0, 0}, {1, 1, 1, 0}});
  // With more of leaf 1 to see, the other pair holds too little of the size.
  CHECK(part_sizes(parts, Labels{1, 1, 0, 0}, meanings, std::vector<float>{100, 20, 60, 100}).count == 2);
  CHECK(part_sizes(parts, Labels{1, 1, 0, 0}, meanings, std::vector<float>{100, 20, 60, 100}).leaves(0) ==
        Labels{1, 0, 0, 0});
}

TEST_CASE("sizes: a size that is far away is better than none, and what does not show is no size") {
  const PartHierarchy parts = two_trees();
  const std::vector<PartMeaning> meanings = {part(0, 0, 0), part(0, 6, 9)};
  const std::vector<float> px = {1, 30, 30, 30};
  CHECK(all_sizes(part_sizes(parts, Labels{1, 0, 0, 0}, meanings, px)) ==
        std::vector<Labels>{{1, 0, 0, 0}, {1, 1, 1, 1}});
  CHECK(part_sizes(parts, Labels{1, 0, 0, 0}, meanings, std::vector<float>{1, 0, 0, 0}).count == 1);
  CHECK(part_sizes(parts, Labels{1, 0, 0, 0}, {}, px).count == 1);
}

TEST_CASE("sizes: they are nested, differ by a fifth at least, and hold what is taken, on random trees") {
  constexpr std::uint32_t kLeaves = 40;
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    PartHierarchy parts;
    parts.leaves = kLeaves;
    std::vector<PartMeaning> meanings;
    for (std::uint32_t t = 0; t < 4; ++t) {
      PartTree& tree = parts.trees.emplace_back();
      std::vector<std::uint32_t> roots(kLeaves);
      for (std::uint32_t l = 0; l < kLeaves; ++l) roots[l] = l;
      tree.parent.assign(kLeaves, kNoPart);
      while (roots.size() > 1) {
        std::ranges::shuffle(roots, random);
        const auto node = static_cast<std::uint32_t>(tree.parent.size());
        for (int child = 0; child < 2; ++child) {
          tree.parent[roots.back()] = node;
          roots.pop_back();
        }
        tree.parent.push_back(kNoPart);
        roots.push_back(node);
      }
      for (std::uint32_t node = 0; node != kNoPart; node = tree.parent[node])
        meanings.push_back(part(t, node, static_cast<float>(random() % 100)));
    }
    std::vector<float> px(kLeaves);
    for (float& p : px) p = static_cast<float>(random() % 50);
    const PartMeaning& chosen = meanings[random() % meanings.size()];
    const Labels taken = leaves_of(parts, chosen.tree, chosen.node);
    const PartSizes sizes = part_sizes(parts, taken, meanings, px);
    REQUIRE(sizes.taken < sizes.count);
    CHECK(sizes.leaves(sizes.taken) == taken);
    const auto pixels = [&](std::size_t size) {
      float sum = 0;
      for (std::uint32_t l = 0; l < kLeaves; ++l) sum += sizes.level[l] <= size ? px[l] : 0;
      return sum;
    };
    for (std::size_t s = 1; s < sizes.count; ++s) {
      const Labels small = sizes.leaves(s - 1), large = sizes.leaves(s);
      for (std::uint32_t l = 0; l < kLeaves; ++l) CHECK(small[l] <= large[l]);
      CHECK(pixels(s) >= 1.199f * pixels(s - 1));
    }
    CHECK(sizes.level[0] == 0);  // every part holds the clicked leaf
  }
}

TEST_CASE("sizes: of a correction, from what it changes up and down, never over a click of the other sign") {
  const SelectionModel model = borders_alone();
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const auto after = [&](const Stroke& first, const Stroke& correction) {
    ClickSelection selection(parts, model);
    selection.apply(view, first);
    REQUIRE(selection.apply(view, correction));
    CHECK(selection.size_masks().size() == selection.sizes());
    return selection;
  };
  const Stroke all = sized(object(5), 1);
  // The spot alone, the clicked half of the second pair, that pair; the first pair holds the click on the
  // object.
  const ClickSelection pair = after(all, rest(35));
  CHECK(pair.labels() == Labels{1, 1, 0, 0});
  REQUIRE(pair.sizes() == 3);
  CHECK(pair.size() == 2);
  CHECK(pair.likeliest_size() == 2);
  CHECK(count(pair.size_masks()[0]) < 80);
  CHECK(count(pair.size_masks()[1]) == 100);
  CHECK(count(pair.size_masks()[2]) == 200);
  CHECK(after(all, sized(rest(35), -1)).labels() == Labels{1, 1, 1, 0});
  const ClickSelection spot = after(all, sized(rest(35), -9));
  CHECK(spot.labels() == Labels{1, 1, 1, 0});  // a stripe is one Gaussian, and the click is obeyed
  CHECK(spot.size() == 0);
  CHECK_FALSE(spot.spot_alone());  // nothing to doubt: it was asked for
  CHECK(after(all, sized(rest(35), 9)).labels() == Labels{1, 1, 0, 0});
  // A click on the object takes what the object lacks.
  const ClickSelection other = after(object(5), object(25));
  CHECK(other.labels() == Labels{1, 1, 1, 1});
  CHECK(other.sizes() == 3);
  CHECK(after(object(5), sized(object(25), -1)).labels() == Labels{1, 1, 1, 0});

  // No click holds what a box took, but a size that takes all of it is none.
  const Stroke around_all = box_around({0, 0}, {40, 10}, SeedLabel::kObject);
  const ClickSelection largest = after(around_all, sized(rest(35), 9));
  CHECK(largest.labels() == Labels{1, 1, 0, 0});
  CHECK(largest.size() + 1 == largest.sizes());

  // What is shown as said already has no sizes, nor has a scribble or a box that corrects.
  CHECK(after(object(5), object(6)).sizes() == 0);
  CHECK(after(all, {SeedLabel::kRest, 1, {{32, 5}, {38, 5}}}).sizes() == 0);
  CHECK(after(all, box_around({20, 0}, {40, 10}, SeedLabel::kRest)).sizes() == 0);
}

TEST_CASE("sizes: of a box, from what it means up and down") {
  SelectionModel model = borders_alone();
  model.box = SelectionModel().box;
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  for (const auto& [step, expected] : {std::pair<int, Labels>{0, {1, 1, 0, 0}}, {1, {1, 1, 1, 1}}}) {
    ClickSelection selection(parts, model);
    REQUIRE(selection.apply(view, sized(box_around({20, 0}, {0, 10}, SeedLabel::kObject), step)));
    CHECK(selection.labels() == expected);
    CHECK(selection.sizes() == 3);
    CHECK(selection.likeliest_size() == 1);
    CHECK(selection.size() == static_cast<std::size_t>(1 + step));
  }
}
