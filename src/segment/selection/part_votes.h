// Votes of the trees: they make one set of leaves from many parts that a stroke can mean.
//
// In: parts with their costs. Out: per leaf the share of the votes. The cheapest part of each tree votes for
// its leaves with the weight exp(least cost - its cost); a tree without a part does not vote. Trees disagree
// where a part is an accident of one tree, so what most of them hold is steadier than the likeliest part
// alone. Cost: linear in the nodes.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

// A part that a stroke can mean: a node of a tree, with the terms of its cost.
struct PartMeaning {
  std::uint32_t tree = 0, node = 0;
  TermValues terms{};
  float cost = 0;
};

// Flags per leaf: 1 if the node holds it.
std::vector<std::uint8_t> leaves_of(const PartHierarchy& parts, std::uint32_t tree, std::uint32_t node);

// The cheapest part of each tree that has one, in the order of the trees. meanings: parts, the cheapest
// first.
std::vector<PartMeaning> voters(const PartHierarchy& parts, std::span<const PartMeaning> meanings);

// How likely one of the meanings is against the first of them, (0, 1].
inline float vote_of(const PartMeaning& voter, std::span<const PartMeaning> meanings) {
  return std::exp(meanings.front().cost - voter.cost);
}

// Share of the votes for each leaf, [0, 1]; empty if no tree votes. meanings: parts, the cheapest first.
std::vector<float> vote_shares(const PartHierarchy& parts, std::span<const PartMeaning> meanings);

// Flags per leaf: 1 if it has more than half of the votes.
std::vector<std::uint8_t> majority(std::span<const float> shares);

}  // namespace splatcut
