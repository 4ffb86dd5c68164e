// What a click on the rest means by colour, where no part fits: the pixels around it that look like the rest.
//
// In: a click on the rest in a view with its colour, and the pixels that certainly are the rest (its disc).
// Out: a region of the displayed object that holds the click. GrabCut settles the displayed border within
// three times the click's distance to it, with the disc as a seed; the region is what becomes the rest and
// hangs together with the click. Parts follow edges of colour in space, and where grass, shadow or padding
// lies against the object there may be none along its border, while a picture shows it.
//
// The region is empty where that would be a guess: if the click is within 6 pixels of the border (it mends
// the border itself); if it is twenty times as large as the disc that reaches to the border; if it looks no
// more like the rest around the object than like what is left of the object. The more it exceeds the disc,
// the more it must: the mean logarithm of how much likelier its colours are in the rest
// (log_ratio_of_colours()) is to reach 0.45 ln(area / disc). These numbers were set by hand on the sessions
// of docs/clicks.md. A click on the object has no such region: what is missing has its colours, but so may
// have the wall behind it. Cost: some 50 ms at 320 px wide.
#pragma once

#include <cstdint>
#include <span>

#include "segment/selection/candidates.h"

namespace splatcut {

// disc: pixels of the view, row by row. Empty mask of the view's size: there is no such region.
Mask region_by_colour(const Click& click, std::span<const std::uint32_t> disc);

}  // namespace splatcut
