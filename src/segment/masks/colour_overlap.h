// How alike colours are: those in a mask and those beside it, those of a region and of the two sides. Bins
// are 8 of each channel of CIE Lab, L of 0 to 100, a and b of -40 to 40 (what is beyond is in the last).
#pragma once

#include <cstdint>

#include "core/image.h"
#include "segment/masks/seeds.h"

namespace splatcut {

inline constexpr std::size_t kColourBins = 512;

// The bin of each pixel's colour.
Image<std::uint16_t> colour_bins(const Image<Rgb8>& picture);

// Of the pixels whose centres lie in `around`: 0 where no colour of the mask stands beside it, 1 where all do
// in equal shares, and where one of the two has no pixel. The sum over bins of the lesser share.
// colour: bins of the pixels.
float overlap_of_colours(const Image<std::uint16_t>& colour, const Mask& mask, const BoxPx& around);

// Mean over the region's pixels of ln((p + e) / (q + e)): p and q the shares of its colour in masks a and b,
// e 0.001. 0 where the region is empty. All of one size.
float log_ratio_of_colours(const Image<Rgb8>& picture, const Mask& region, const Mask& a, const Mask& b);

}  // namespace splatcut
