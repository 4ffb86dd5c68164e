// Terms and sums that the costs of a click's meanings and of a box's meanings share.
#pragma once

#include <cstdint>
#include <vector>

#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

// Sums of a value over the leaves of each node. of_leaves: the value of each leaf.
std::vector<float> summed(const PartTree& tree, std::vector<float> of_leaves);

// Flags per node: 1 if the node or one of its ancestors is marked. marked: flags per node.
std::vector<std::uint8_t> below(const PartTree& tree, std::vector<std::uint8_t> marked);

// Term kCut: ln(length of the node's border / sqrt(area)), at least `least`.
float log_cut(const PartTree& tree, std::uint32_t node, float least);
inline constexpr float kLeastFirstCut = -12;  // `least` of log_cut() for first clicks and boxes

// Sets the terms that say how a part looks in all views: kNoEdge, kCropped, kSmall, kLarge, kFrame.
void set_look_terms(const PartLooks& looks, TermValues* terms);

// Weighted sum of the terms.
float cost_of(const TermValues& terms, const TermValues& weights);

}  // namespace splatcut
