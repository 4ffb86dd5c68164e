// What the costs of a click's and a box's meanings share.
#pragma once

#include <cstdint>
#include <vector>

#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

// Per node of the tree, the sum over its leaves. of_leaves: per leaf.
std::vector<float> summed(const PartTree& tree, std::vector<float> of_leaves);

// Per node, 1 where it or one of its ancestors is marked. marked: per node.
std::vector<std::uint8_t> below(const PartTree& tree, std::vector<std::uint8_t> marked);

// ln(length of the node's border / sqrt(area)), at least `least`.
float log_cut(const PartTree& tree, std::uint32_t node, float least);
inline constexpr float kLeastFirstCut = -12;  // of a part that touches nothing, as a first stroke counts it

// Sets the terms that say how a part looks in all views: kNoEdge, kCropped, kSmall, kLarge, kFrame.
void set_look_terms(const PartLooks& looks, TermValues* terms);

float cost_of(const TermValues& terms, const TermValues& weights);

}  // namespace splatcut
