// Scribbles that were saved as a picture.
#pragma once

#include "core/image.h"
#include "segment/masks/seeds.h"

namespace splatcut {

// Discs along what is drawn (non-zero), as clicks with a radius; none is nearer to another than it is wide,
// or than a hundredth of the picture's width. Centres lie on what is drawn, those near its middle come first:
// what the first click means weighs most.
Strokes strokes_of_picture(const Mask& drawn, SeedLabel label);

}  // namespace splatcut
