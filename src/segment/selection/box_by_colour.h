// What a box means by colour: its one answer that no part of any tree has to be.
//
// In: hierarchy, a view with its colour, a box around an object. Outside of the box is the rest, its middle
// is the object, and GrabCut tells the two apart by colour between them; leaves follow by parts_of_mask().
// That finds what differs in colour from all around it and falls apart into parts that nothing joins, and
// loses much of what shares its colours with its surroundings. So it counts as the better answer than another
// set of leaves only where the sum of fit and 4 overlap is less by more than 0.55. fit: kShort, kSpill and
// kFills with their weights (box_meanings.h). overlap: overlap_of_colours() of the set's picture in
// the box grown by a quarter. Both numbers were searched on the boxes of docs/clicks.md, where it says what
// leaving out a capture costs. Cost: some 0.4 s at 320 px wide, the most of it GrabCut's five rounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/box_meanings.h"

namespace splatcut {

// Flags per leaf; none if the view has no colour.
std::vector<std::uint8_t> leaves_by_colour(const PartHierarchy& parts, const LeafView& view,
                                           const Stroke& box);

// The same kept with a view, as other meanings and sizes of a box ask again.
struct KnownByColour {
  std::vector<glm::vec2> box_px;     // corners; empty: of no box
  std::vector<std::uint8_t> leaves;  // flags
  const std::vector<std::uint8_t>& of(const PartHierarchy& parts, const LeafView& view, const Stroke& box);
};

// Whether the leaves found by colour are a better answer to the box than the others. meanings: of this box in
// this view.
bool stands_out_more(const BoxMeanings& meanings, const LeafView& view, const BoxPx& box,
                     std::span<const std::uint8_t> by_colour, std::span<const std::uint8_t> others);

}  // namespace splatcut
