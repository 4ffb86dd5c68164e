// What a click on the rest leads to: what would go with it, but for other things elsewhere in the picture.
//
// In: a click in a view with its colour, and the leaves that it would make rest. Out: the same without those
// that show mostly where no way leads to from the click within what would become rest, if that looks more
// like what would stay of the object. Parts join what lies apart: a right click on a hedge took the foot of
// the pillar before it along. What lies apart and looks alike goes all the same: the leaves of a plant on
// both sides of its pot.
//
// Ways lead from pixel to pixel and across gaps of 4 pixels. What lies apart looks more like the object where
// log_ratio_of_colours() of all of it is below -0.5, a number that was set by hand (docs/clicks.md, "Within
// reach"). Leaves that the view does not show follow, and so does all where the view has no colour. Cost: a
// few passes over the view's pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/candidates.h"

namespace splatcut {

// object: labels per leaf before the click. leaves: flags per leaf of what is meant.
std::vector<std::uint8_t> within_reach(const Click& click, std::span<const std::uint8_t> object,
                                       std::vector<std::uint8_t> leaves);

}  // namespace splatcut
