// What the first click or box can mean, and can still mean after corrections.
//
// In: the selection so far, with what was said first. Out: how alike its meanings are; those that
// no click speaks against, and what the trees agree on among them. Cost: linear in the nodes of all trees.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/candidates.h"
#include "segment/selection/part_votes.h"

namespace splatcut {

// Mean IoU of a set of leaves with the meanings, weighted by their likelihood, [0, 1]. Where it is low, the
// set may well be another thing than was meant. boxed: the cheapest of each tree alone, as the costs of a box
// say too little of the others. Meanings less than e^-6 as likely as the first count for nothing. meanings:
// the cheapest first, at least one. set: flags per leaf. leaf_px: pixels per leaf.
float certainty_of(const PartHierarchy& parts, std::span<const PartMeaning> meanings,
                   std::span<const std::uint8_t> set, std::span<const float> leaf_px, bool boxed);

// Meanings of what was said first that hold every leaf clicked on the object and none clicked on the rest,
// and `leaf` as `object` says, the likeliest first. Precondition: something was said.
std::vector<PartMeaning> meanings_left(const PartHierarchy& parts, const SelectedParts& selected,
                                       std::uint32_t leaf, bool object);

struct AgreedMeaning {
  std::vector<std::uint8_t> leaves;  // flags per leaf: 1 if more than half of the votes are for it
  // How little the trees agree: sum over the leaves' pixels of the smaller share of the votes, for or
  // against, divided by the pixels of `leaves`; at least 0.
  float doubt = 0;
};

// What the votes of the trees (part_votes.h) make of meanings, the cheapest first; there is at least one.
// leaf_px: pixels per leaf.
AgreedMeaning agreed_meaning(const PartHierarchy& parts, std::span<const PartMeaning> meanings,
                             std::span<const float> leaf_px);

}  // namespace splatcut
