// What the first click or box can still mean after corrections.
//
// In: the selection so far, with what was said first. Out: its meanings that no click speaks against, and
// what the trees agree on among them. Cost: linear in the nodes of all trees.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/candidates.h"
#include "segment/selection/part_votes.h"

namespace splatcut {

// The first click's candidates that hold every leaf clicked on the object, none clicked on the rest, and not
// `leaf`, the likeliest first. Precondition: there was a first click.
std::vector<PartMeaning> first_meanings_left(const SelectedParts& selected, std::uint32_t leaf);

// Meanings of the box that hold every leaf clicked on the object and none clicked on the rest, and `leaf` as
// `object` says, the likeliest first. Precondition: a box was first.
std::vector<PartMeaning> box_meanings_left(const PartHierarchy& parts, const SelectedParts& selected,
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
