// How alike the colours in a mask and those beside it are.
#pragma once

#include "core/image.h"
#include "segment/masks/seeds.h"

namespace splatcut {

// Of the pixels whose centres lie in `around`: 0 where no colour of the mask stands beside it, 1 where all do
// in equal shares, and where one of the two has no pixel. The sum over bins of the lesser share; bins are 8
// of each channel of CIE Lab, L of 0 to 100, a and b of -40 to 40 (what is beyond is in the last).
float overlap_of_colours(const Image<Rgb8>& picture, const Mask& mask, const BoxPx& around);

}  // namespace splatcut
