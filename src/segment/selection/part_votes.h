// One set of leaves from many parts that a stroke can mean: the trees vote.
//
// In: parts with their costs. The cheapest part of each tree votes with exp(least cost - its cost) for its
// leaves; trees without a part do not vote. Out: per leaf the share of the votes. Trees disagree where a part
// is an accident of one of them; what most of them hold is steadier than the likeliest part alone. Cost:
// linear in the nodes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

struct PartMeaning {
  std::uint32_t tree = 0, node = 0;
  TermValues terms{};
  float cost = 0;
};

// The leaves of one node: 1 each.
std::vector<std::uint8_t> leaves_of(const PartHierarchy& parts, std::uint32_t tree, std::uint32_t node);

// Per leaf the share in [0, 1]; empty where no tree votes. meanings: cheapest first.
std::vector<float> vote_shares(const PartHierarchy& parts, std::span<const PartMeaning> meanings);

// The leaves of more than half of the votes.
std::vector<std::uint8_t> majority(std::span<const float> shares);

}  // namespace splatcut
