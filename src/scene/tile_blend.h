// Blending of binned splats into pixels: the second half of rasterize().
#pragma once

#include <cstdint>

#include "scene/tile_grid.h"

namespace splatcut {

// What one pair of splat and tile adds to MaskedSums, 2^-16 pixel: at most 256 pixels, which fits 32 bits.
struct PairSums {
  std::uint32_t total, inside;
};

// Draws those tiles of the grid that touch roi into `out`, whose images have the size of roi. shown: empty, or per
// Gaussian whether it is drawn, where the grid holds more. pair_sums: null, or an element for each entry of the grid,
// set for those drawn. Same bits on every SIMD target and any number of threads: pixels
// are independent lanes, FMA is explicit, sums are integers.
void blend_tiles(const TileGrid& grid, const RasterOptions& options, const PixelRect& roi, std::span<const std::uint8_t> shown,
                 const Job& job, PairSums* pair_sums, RasterOutput* out);

// Name of the SIMD target in use.
const char* blend_simd_target();

}  // namespace splatcut
