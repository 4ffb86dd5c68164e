// A hierarchy small enough to work out by hand.
#pragma once

#include <array>

#include "segment/part_hierarchy.h"

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

}  // namespace splatcut::testing
