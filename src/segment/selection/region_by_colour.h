// What a click on the rest means by colour, where no part fits: the pixels around it that look like the rest.
//
// In: a click on the rest in a view with its colour, and the pixels that certainly are the rest (its disc).
// Out: a region of the displayed object that holds the click. GrabCut settles the displayed border within
// three times the click's distance to it, with the disc as a seed; the region is what becomes the rest and
// hangs together with the click. Parts follow edges of colour in space, and where grass, shadow or padding
// lies against the object there may be none along its border, while a picture shows it.
//
// The region is empty where it would be a guess: if the click is within 6 pixels of the border, which it then
// mends itself; if the region is twenty times as large as the disc that reaches to the border; or if its
// colours do not speak for the rest. log_ratio_of_colours() says how much likelier they are around the object
// than in what is left of the object. It has to reach 0.45 ln(area of the region / area of that disc): a
// larger region needs clearer colours. These numbers were set by hand on the sessions of docs/clicks.md. A
// click on the object has no such region: what is missing looks like the object, but so may the wall behind
// it. Cost: some 50 ms at 320 px wide.
#pragma once

#include <cstdint>
#include <span>

#include "segment/selection/candidates.h"

namespace splatcut {

// disc: pixels of the view, row by row. A region of more_than_px pixels or fewer is none. Empty mask of the
// view's size: there is no such region.
Mask region_by_colour(const Click& click, std::span<const std::uint32_t> disc, float more_than_px = 0);

}  // namespace splatcut
