#include "scene/raster/tile_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/raster/block_view.h"
#include "scene/raster/splat_projection.h"

namespace splatcut {

namespace {

struct TileSpan {
  int x0, x1, y0, y1;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool is_line() const { return x1 - x0 == 1 || y1 - y0 == 1; }
};

// The tile of the grid that holds a pixel position, in one direction; below 0 and above count are clamped.
int tile_at(float px, int first, int count) {
  const float tile = px * (1.0f / kTilePx) - static_cast<float>(first);
  return static_cast<int>(std::clamp(tile, 0.0f, static_cast<float>(count)));
}

// Pixel centres lie half a pixel inside their tile; a little is left for rounding.
constexpr float kCentreInset = 0.45f;

// Tiles with pixel centres from low_px to high_px, as a half-open range of the grid.
std::pair<int, int> tile_range(float low_px, float high_px, int first, int count) {
  const float low = low_px + kCentreInset, high = high_px - kCentreInset;
  return {tile_at(low, first, count),
          high < static_cast<float>(first * kTilePx) ? 0 : std::min(tile_at(high, first, count) + 1, count)};
}

TileSpan span_of(const SplatBatch& b, int i, const TileGrid& grid) {
  const auto [x0, x1] = tile_range(b.x_px[i] - b.half_width_px[i], b.x_px[i] + b.half_width_px[i],
                                   grid.first_tile_x, grid.tiles_x);
  const auto [y0, y1] = tile_range(b.y_px[i] - b.half_height_px[i], b.y_px[i] + b.half_height_px[i],
                                   grid.first_tile_y, grid.tiles_y);
  return {x0, x1, y0, y1};
}

// The ellipse alpha >= 1/255 of a splat: at height dy above its mean it reaches from
// tilt dy - sqrt(width2 - slope dy^2) to tilt dy + sqrt(width2 - slope dy^2), and farthest at dy = +-tip.
struct Ellipse {
  float tilt, width2, slope, tip;

  explicit Ellipse(const SplatBatch& b, int i)
      : tilt(-0.5f * b.qb[i] / b.qa[i]),
        width2((b.log2_opacity[i] - kLog2AlphaMin + kLog2AlphaSlack) / -b.qa[i]),
        slope(b.qc[i] / b.qa[i] - tilt * tilt),
        tip(tilt *
            std::sqrt(width2 / std::max(slope * (slope + tilt * tilt), std::numeric_limits<float>::min()))) {}

  float half_width(float dy) const { return std::sqrt(std::max(0.0f, width2 - slope * dy * dy)); }
  // Farthest to the right and, by symmetry, to the left between two heights.
  float right(float dy0, float dy1) const {
    const float dy = std::clamp(tip, dy0, dy1);
    return tilt * dy + half_width(dy);
  }
  float left(float dy0, float dy1) const { return -right(-dy1, -dy0); }
};

template <class Visit>
void visit_tiles(const SplatBatch& b, int i, const TileGrid& grid, const Visit& visit) {
  const TileSpan span = span_of(b, i, grid);
  if (span.empty()) return;
  if (span.is_line()) {  // the box is tight: its only row or column of tiles is touched all along
    for (int ty = span.y0; ty < span.y1; ++ty)
      for (int tx = span.x0; tx < span.x1; ++tx) visit(ty * grid.tiles_x + tx);
    return;
  }
  const Ellipse ellipse(b, i);
  for (int ty = span.y0; ty < span.y1; ++ty) {
    const float border = static_cast<float>((ty + grid.first_tile_y) * kTilePx) - b.y_px[i];
    const float top = border + kCentreInset, bottom = border + kTilePx - kCentreInset;
    const auto [x0, x1] = tile_range(b.x_px[i] + ellipse.left(top, bottom),
                                     b.x_px[i] + ellipse.right(top, bottom), grid.first_tile_x, grid.tiles_x);
    for (int tx = std::max(x0, span.x0); tx < std::min(x1, span.x1); ++tx) visit(ty * grid.tiles_x + tx);
  }
}

// Gaussians per run: the same for any number of threads, and few enough runs that their counts per tile stay
// small.
std::size_t run_size(std::size_t gaussians) {
  constexpr std::size_t kSmallest = 32 * SplatBatch::kGaussians, kMostRuns = 256;
  const std::size_t batches = (gaussians / kMostRuns + SplatBatch::kGaussians) / SplatBatch::kGaussians;
  return std::max(kSmallest, batches * SplatBatch::kGaussians);
}

// One run of Gaussians on its way into the grid.
struct Run {
  std::vector<std::uint32_t> place;  // per tile: pairs of this run, then the entry where the next one goes
};

// Lists the splats of the Gaussians begin <= g < end with their tiles, which stand in SplatTile::entry for
// now. room: pairs that may be listed by all runs together; below 0, the run ends early.
void project_run(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                 const PixelRect& region, std::size_t begin, std::size_t end, TileGrid* grid, Run* run,
                 std::vector<SplatTile>* pairs, std::atomic<std::int64_t>* room) {
  run->place.assign(static_cast<std::size_t>(grid->tiles()), 0);
  SplatBatch batch;
  static_assert(SplatBatch::kGaussians == CloudBlocks::kGaussians);
  const BlockView view(camera, options.near_plane.value_or(near_plane_for(cloud, camera)),
                       options.low_pass_px2, region);
  for (std::size_t g = begin; g < end; g += SplatBatch::kGaussians) {
    if (options.blocks && !view.may_show(options.blocks->blocks()[g / CloudBlocks::kGaussians])) continue;
    const std::size_t last = std::min(end, g + SplatBatch::kGaussians);
    project_batch(cloud, static_cast<std::uint32_t>(g), static_cast<std::uint32_t>(last), camera, options,
                  region, &batch);
    const std::size_t before = pairs->size();
    for (int i = 0; i < batch.size; ++i) {
      const std::uint32_t gaussian = batch.gaussian[i];
      grid->splats[gaussian] = {batch.x_px[i], batch.y_px[i],         batch.qa[i],  batch.qb[i],
                                batch.qc[i],   batch.log2_opacity[i], batch.red[i], batch.green[i],
                                batch.blue[i], batch.depth[i]};
      visit_tiles(batch, i, *grid, [&](int tile) {
        pairs->push_back({gaussian, static_cast<std::uint32_t>(tile)});
        ++run->place[static_cast<std::size_t>(tile)];
      });
    }
    const auto added = static_cast<std::int64_t>(pairs->size() - before);
    if (room->fetch_sub(added, std::memory_order_relaxed) < added) return;
  }
}

// Turns the counts of all runs into places: tile by tile, and within a tile run by run.
void assign_places(std::vector<Run>* runs, TileGrid* grid) {
  const auto tiles = static_cast<std::size_t>(grid->tiles());
  std::vector<std::uint32_t>& next = grid->first_entry;
  next.assign(tiles + 1, 0);
  for (const Run& run : *runs)
    for (std::size_t t = 0; t < tiles; ++t) next[t + 1] += run.place[t];
  for (std::size_t t = 0; t < tiles; ++t) next[t + 1] += next[t];
  std::vector<std::uint32_t> place(next.begin(), next.end() - 1);
  for (Run& run : *runs)
    for (std::size_t t = 0; t < tiles; ++t) place[t] += std::exchange(run.place[t], place[t]);
}

// Gives every pair its entry in place of its tile.
void fill_entries(Run* run, std::vector<SplatTile>* pairs, TileGrid* grid) {
  for (SplatTile& pair : *pairs) {
    pair.entry = run->place[pair.entry]++;
    grid->entries[pair.entry] = {grid->splats[pair.gaussian].depth, pair.gaussian};
  }
}

std::span<const TileEntry> entries_of(const TileGrid& grid, int tile) {
  const auto t = static_cast<std::size_t>(tile);
  return {grid.entries.data() + grid.first_entry[t], grid.first_entry[t + 1] - grid.first_entry[t]};
}

// order: as many as entries.
void sort_front_to_back(std::span<const TileEntry> entries, SortSpace* space, std::uint32_t* order) {
  space->items.resize(entries.size());
  space->scratch.resize(entries.size());
  // Positive floats order like their bits.
  for (std::size_t i = 0; i < entries.size(); ++i)
    space->items[i] = {std::bit_cast<std::uint32_t>(entries[i].depth), static_cast<std::uint32_t>(i)};
  radix_sort<8>(std::span(space->items), std::span(space->scratch), 0, 32);
  std::ranges::transform(space->items, order, &KeyValue<std::uint32_t>::value);
}

}  // namespace

TileGrid bin_splats(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                    const Job& job) {
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  TileGrid grid;
  const TilesOf tiles = tiles_of(roi);
  grid.first_tile_x = tiles.first_x;
  grid.first_tile_y = tiles.first_y;
  grid.tiles_x = tiles.across;
  grid.tiles_y = tiles.down;
  constexpr int kMostTiles = 1 << 16;  // each run counts in each tile
  grid.too_large = grid.tiles() > kMostTiles;
  if (grid.too_large) return grid;
  std::atomic<std::int64_t> room = grid.tiles() > 1 ? static_cast<std::int64_t>(options.most_pairs)
                                                    : std::numeric_limits<std::int64_t>::max();
  grid.splats = LargeArray<BlendSplat>(cloud.size());
  const std::size_t step = run_size(cloud.size()), count = (cloud.size() + step - 1) / step;
  std::vector<Run> runs(count);
  grid.runs.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t r) {
    if (job.cancelled()) return;
    project_run(cloud, camera, options, roi, r * step, std::min(cloud.size(), (r + 1) * step), &grid,
                &runs[r], &grid.runs[r], &room);
  });
  grid.too_large = room < 0;
  if (grid.too_large) return grid;
  grid.first_entry.assign(static_cast<std::size_t>(grid.tiles()) + 1, 0);
  if (job.cancelled()) return grid;
  assign_places(&runs, &grid);
  grid.entries = LargeArray<TileEntry>(grid.first_entry.back());
  tbb::parallel_for(std::size_t{0}, count,
                    [&](std::size_t r) { fill_entries(&runs[r], &grid.runs[r], &grid); });
  return grid;
}

std::span<const std::uint32_t> drawn_order(const TileGrid& grid, int tile,
                                           std::span<const std::uint8_t> shown, SortSpace* space) {
  const std::span<const TileEntry> entries = entries_of(grid, tile);
  std::span<const std::uint32_t> order;
  if (grid.order.size() != 0) {
    order = {grid.order.data() + grid.first_entry[static_cast<std::size_t>(tile)], entries.size()};
  } else {
    space->order.resize(entries.size());
    sort_front_to_back(entries, space, space->order.data());
    order = space->order;
  }
  if (shown.empty()) return order;
  space->shown.clear();
  for (const std::uint32_t e : order)
    if (shown[entries[e].gaussian]) space->shown.push_back(e);
  return space->shown;
}

void sort_tiles(TileGrid* grid, const Job& job) {
  grid->order = LargeArray<std::uint32_t>(grid->entries.size());
  tbb::parallel_for(0, grid->tiles(), [&](int tile) {
    thread_local SortSpace space;
    if (!job.cancelled())
      sort_front_to_back(entries_of(*grid, tile), &space,
                         grid->order.data() + grid->first_entry[static_cast<std::size_t>(tile)]);
  });
}

}  // namespace splatcut
