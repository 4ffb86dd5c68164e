// Blending of binned splats into pixels: the second half of rasterize().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/raster/tile_grid.h"

namespace splatcut {

// What one pair of splat and tile adds to MaskedSums, 2^-16 pixel: at most 256 pixels, which fits 32 bits.
struct PairSums {
  std::uint32_t total, inside;
};

// Per block of pixels, the splats of the tile that touch it, front to back, up to where it is opaque. Found
// while all splats are drawn; any later drawing of all splats can use them.
struct TileLists {
  std::vector<std::uint8_t> splat;   // by chunk of the tile's order, then by block: places within the chunk
  std::vector<std::uint16_t> count;  // per chunk and block
  bool complete = false;
};

struct TileBlend {
  const TileGrid& grid;
  const RasterOptions& options;
  PixelRect roi;
  std::span<const std::uint8_t>
      shown;  // empty, or per Gaussian whether it is drawn, where the grid holds more
  std::vector<TileLists>* lists = nullptr;  // per tile, where shown is empty: used once complete
  PixelRect picture{};  // all that the grid holds: lists of tiles that roi shows whole are completed
  PairSums* pair_sums = nullptr;       // null, or one per entry of the grid; those drawn are set
  std::int32_t* plane_sums = nullptr;  // null, or by entry of the grid and plane, zero: those drawn are set
};

// Draws those tiles of the grid that touch roi, which may reach beyond the grid, into `out`, whose images
// have the size of roi. Same bits on every SIMD target and any number of threads, with lists or without:
// pixels are independent lanes, FMA is explicit, sums are integers.
void blend_tiles(const TileBlend& what, const Job& job, RasterOutput* out);

}  // namespace splatcut
