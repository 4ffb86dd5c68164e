// Splats of one view, projected and listed per 16x16 tile: the first half of rasterize().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/large_array.h"
#include "core/radix_sort.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

inline constexpr int kTilePx = 16;

// The tiles of the whole picture that a region touches, row by row.
struct TilesOf {
  int first_x, first_y, across, down;
  std::size_t size() const { return static_cast<std::size_t>(across) * static_cast<std::size_t>(down); }
  std::size_t index(int x_px, int y_px) const {
    return static_cast<std::size_t>((y_px / kTilePx - first_y) * across + x_px / kTilePx - first_x);
  }
};
inline TilesOf tiles_of(const PixelRect& region) {
  const int x = region.x0 / kTilePx, y = region.y0 / kTilePx;
  return {x, y, (region.x1 + kTilePx - 1) / kTilePx - x, (region.y1 + kTilePx - 1) / kTilePx - y};
}
inline constexpr float kLog2AlphaMin = -7.994353436858858f;  // log2(1/255)
// Slack on log2(alpha) where faint splats are left out early: only the test per pixel may decide at the
// threshold.
inline constexpr float kLog2AlphaSlack = 1e-2f;

// What blending needs of one splat. alpha = min(0.99, 2^(log2_opacity + qa dx^2 + qb dx dy + qc dy^2)).
struct BlendSplat {
  float x_px, y_px;
  float qa, qb, qc;  // conic times -log2(e)/2 (qb: times -log2(e))
  float log2_opacity;
  float red, green, blue;
  float depth;
};

// A splat in a tile.
struct TileEntry {
  float depth;  // > 0
  std::uint32_t gaussian;
};

// The same pair from the splat's side.
struct SplatTile {
  std::uint32_t gaussian;
  std::uint32_t entry;  // index into TileGrid::entries
};

struct TileGrid {
  int tiles_x = 0, tiles_y = 0;
  int first_tile_x = 0, first_tile_y = 0;  // of the region drawn, in tiles of the whole picture
  bool too_large = false;                  // more tiles or pairs than fit in memory: all else is then unset
  LargeArray<BlendSplat> splats;           // by Gaussian; only those in entries have a value
  LargeArray<TileEntry> entries;           // tile by tile; within a tile in cloud order
  std::vector<std::uint32_t> first_entry;  // tiles_x * tiles_y + 1
  LargeArray<std::uint32_t> order;         // of each tile's entries, front to back; empty until sort_tiles()
  // Runs of Gaussians: what each run's splats touch, in cloud order. No Gaussian is in two runs.
  std::vector<std::vector<SplatTile>> runs;

  int tiles() const { return tiles_x * tiles_y; }
};

// too_large: beyond options.most_pairs, except for a region of one tile, or beyond 16 million pixels.
TileGrid bin_splats(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                    const Job& job);

// Scratch memory for sorting one tile.
struct SortSpace {
  std::vector<KeyValue<std::uint32_t>> items, scratch;
  std::vector<std::uint32_t> order, shown;
};

// The entries of a tile that are shown (empty: all), front to back, ties in cloud order: offsets from the
// tile's first entry. Good until the next call with that space.
std::span<const std::uint32_t> drawn_order(const TileGrid& grid, int tile,
                                           std::span<const std::uint8_t> shown, SortSpace* space);

// Sorts all tiles, for a grid that is drawn more than once.
void sort_tiles(TileGrid* grid, const Job& job);

}  // namespace splatcut
