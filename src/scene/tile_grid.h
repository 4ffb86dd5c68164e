// Splats of one view, projected, sorted by depth and listed per 16x16 tile: the first half of rasterize().
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/rasterizer.h"

namespace splatcut {

inline constexpr int kTilePx = 16;

// What blending needs of one splat. alpha = min(0.99, 2^(log2_opacity + qa dx^2 + qb dx dy + qc dy^2)).
struct BlendSplat {
  float x_px, y_px;
  float qa, qb, qc;  // conic times -log2(e)/2 (qb: times -log2(e))
  float log2_opacity;
  float half_width_px, half_height_px;  // box in which alpha >= 1/255
  float red, green, blue;
  float depth;
  std::uint32_t gaussian;
};

struct TileGrid {
  int tiles_x = 0, tiles_y = 0;
  int first_tile_x = 0, first_tile_y = 0;     // of the region drawn, in tiles of the whole picture
  std::vector<BlendSplat> splats;             // in cloud order
  std::vector<std::uint32_t> entries;         // indices into splats; per tile front to back
  std::vector<std::uint32_t> first_entry;     // tiles_x * tiles_y + 1
};

TileGrid bin_splats(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options, const Job& job);

}  // namespace splatcut
