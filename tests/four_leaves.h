// A hierarchy small enough to work out by hand.
#pragma once

#include <array>

#include "segment/selection/leaf_view.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut::testing {

// Four leaves of one Gaussian each, one unit apart, of area 1, in one tree: ((0 1) (2 3)). The pairs have
// hardly any border, and merging them is dear.
inline PartHierarchy four_leaves() {
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
  parts.plain_trees = 1;
  parts.leaf_area = {1, 1, 1, 1};
  for (int l = 0; l < 4; ++l) parts.leaf_centre_world.emplace_back(static_cast<float>(l) - 1.5f, 0.0f, 0.0f);
  return parts;
}

inline ListedWeights listed(const Image<std::vector<GroupWeight>>& lists) {
  ListedWeights out;
  out.of = Image<std::span<GroupWeight>>(lists.width(), lists.height());
  out.memory.assign(lists.pixels().begin(), lists.pixels().end());
  std::ranges::copy(out.memory, out.of.pixels().begin());
  return out;
}

// What is at each pixel, and nothing behind it. hit: a Gaussian, or -1.
inline LeafView leaf_view_of_hits(const PartHierarchy& parts, const Camera& camera,
                                  const Image<std::int32_t>& hit) {
  Image<std::vector<GroupWeight>> lists(hit.width(), hit.height());
  Image<float> depth(hit.width(), hit.height(), 0.0f);
  for (std::size_t i = 0; i < hit.size(); ++i) {
    if (hit.pixels()[i] < 0) continue;
    const auto gaussian = static_cast<std::uint32_t>(hit.pixels()[i]);
    lists.pixels()[i] = {{gaussian, 1}};
    const std::uint32_t leaf = parts.leaf_of[gaussian];
    if (leaf != kNoPart) depth.pixels()[i] = camera.camera_from_world(parts.leaf_centre_world[leaf]).z;
  }
  return leaf_view_of(parts, camera, listed(lists), std::move(depth));
}

}  // namespace splatcut::testing
