#include "scene/tile_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "scene/radix_sort.h"
#include "scene/splat_math.h"

namespace splatcut {

namespace {

constexpr std::size_t kChunk = 8192;  // fixed, so that no result depends on the number of threads
constexpr float kLog2E = 1.4426950408889634f;

struct TileSpan {
  int x0, x1, y0, y1;
};

TileSpan tiles_of(const BlendSplat& s, const TileGrid& grid) {
  const auto tile = [](float px, int first, int count) {
    return std::clamp(static_cast<int>(std::floor(px / kTilePx)) - first, 0, count);
  };
  return {tile(s.x_px - s.half_width_px, grid.first_tile_x, grid.tiles_x),
          std::min(tile(s.x_px + s.half_width_px, grid.first_tile_x, grid.tiles_x) + 1, grid.tiles_x),
          tile(s.y_px - s.half_height_px, grid.first_tile_y, grid.tiles_y),
          std::min(tile(s.y_px + s.half_height_px, grid.first_tile_y, grid.tiles_y) + 1, grid.tiles_y)};
}

// Largest exponent q (<= 0) that the splat reaches inside the tile [x0, x1] x [y0, y1] of pixel centres:
// at the mean if inside, else on the border, where each edge is a parabola.
float largest_exponent(const BlendSplat& s, float x0, float y0, float x1, float y1) {
  const float dx0 = x0 - s.x_px, dx1 = x1 - s.x_px, dy0 = y0 - s.y_px, dy1 = y1 - s.y_px;
  if (dx0 <= 0 && dx1 >= 0 && dy0 <= 0 && dy1 >= 0) return 0;
  const auto at = [&](float dx, float dy) { return s.qa * dx * dx + s.qb * dx * dy + s.qc * dy * dy; };
  float best = -1e30f;
  for (const float dx : {dx0, dx1}) best = std::max(best, at(dx, std::clamp(-0.5f * s.qb * dx / s.qc, dy0, dy1)));
  for (const float dy : {dy0, dy1}) best = std::max(best, at(std::clamp(-0.5f * s.qb * dy / s.qa, dx0, dx1), dy));
  return best;
}

constexpr float kLog2AlphaMin = -7.994353436858858f;

bool touches_tile(const BlendSplat& s, const TileGrid& grid, int tx, int ty) {
  constexpr float kRoundingSlack = 1e-2f;  // never drop a tile for rounding; the pixel test decides
  const float x0 = static_cast<float>((tx + grid.first_tile_x) * kTilePx) + 0.5f;
  const float y0 = static_cast<float>((ty + grid.first_tile_y) * kTilePx) + 0.5f;
  return s.log2_opacity + largest_exponent(s, x0, y0, x0 + kTilePx - 1, y0 + kTilePx - 1) >=
         kLog2AlphaMin - kRoundingSlack;
}

template <class Visit>
void visit_tiles(const BlendSplat& s, const TileGrid& grid, const Visit& visit) {
  const TileSpan span = tiles_of(s, grid);
  if (span.x1 - span.x0 <= 1 && span.y1 - span.y0 <= 1) {
    if (span.x0 < span.x1 && span.y0 < span.y1) visit(span.y0 * grid.tiles_x + span.x0);
    return;
  }
  for (int ty = span.y0; ty < span.y1; ++ty)
    for (int tx = span.x0; tx < span.x1; ++tx)
      if (touches_tile(s, grid, tx, ty)) visit(ty * grid.tiles_x + tx);
}

bool blend_splat(const GaussianCloud& cloud, std::uint32_t g, const Camera& camera, const RasterOptions& options,
                 const glm::vec3& eye_world, const PixelRect& region, BlendSplat* out) {
  Splat s;
  if (!project(cloud, g, camera, options.near_plane, &s)) return false;
  if (s.mean_px.x + s.extent_px.x < static_cast<float>(region.x0) || s.mean_px.x - s.extent_px.x > static_cast<float>(region.x1) ||
      s.mean_px.y + s.extent_px.y < static_cast<float>(region.y0) || s.mean_px.y - s.extent_px.y > static_cast<float>(region.y1))
    return false;
  glm::vec3 colour(0);
  if (!options.colour_override.empty())
    colour = options.colour_override[g];
  else if (options.colour)
    colour = sh_colour(cloud.f_dc[g], cloud.sh_rest_of(g), cloud.sh_degree, glm::normalize(cloud.position[g] - eye_world));
  *out = {s.mean_px.x, s.mean_px.y, -0.5f * kLog2E * s.conic.a, -kLog2E * s.conic.b, -0.5f * kLog2E * s.conic.c,
          std::log2(cloud.opacity[g]), s.extent_px.x, s.extent_px.y, colour.r, colour.g, colour.b, s.depth, g};
  return true;
}

void project_all(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                 const PixelRect& region, const Job& job, TileGrid* grid) {
  const std::size_t chunks = (cloud.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<BlendSplat>> found(chunks);
  const glm::vec3 eye_world = camera.centre_world();
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    if (job.cancelled()) return;
    BlendSplat s;
    const auto end = static_cast<std::uint32_t>(std::min(cloud.size(), (c + 1) * kChunk));
    for (auto g = static_cast<std::uint32_t>(c * kChunk); g < end; ++g) {
      if (!options.shown.empty() && !options.shown[g]) continue;
      if (blend_splat(cloud, g, camera, options, eye_world, region, &s)) found[c].push_back(s);
    }
  });
  std::size_t total = 0;
  for (const auto& f : found) total += f.size();
  grid->splats.reserve(total);
  for (const auto& f : found) grid->splats.insert(grid->splats.end(), f.begin(), f.end());
}

// Positive floats order like their bits.
std::vector<std::uint32_t> order_by_depth(const std::vector<BlendSplat>& splats) {
  std::vector<KeyValue<std::uint32_t>> items(splats.size()), scratch;
  for (std::size_t i = 0; i < splats.size(); ++i)
    items[i] = {std::bit_cast<std::uint32_t>(splats[i].depth), static_cast<std::uint32_t>(i)};
  radix_sort(items, scratch, 32);
  std::vector<std::uint32_t> order(items.size());
  std::transform(items.begin(), items.end(), order.begin(), [](const auto& item) { return item.value; });
  return order;
}

// Counting sort by tile of the depth order: chunks count, a scan gives each chunk its places, chunks fill.
void fill_tiles(const std::vector<std::uint32_t>& order, const Job& job, TileGrid* grid) {
  const std::size_t tiles = static_cast<std::size_t>(grid->tiles_x) * grid->tiles_y;
  constexpr std::size_t kBinChunk = 65536;
  const std::size_t chunks = (order.size() + kBinChunk - 1) / kBinChunk;
  std::vector<std::vector<std::uint32_t>> hits(chunks);   // (tile) per pair, in depth order
  std::vector<std::vector<std::uint32_t>> owner(chunks);  // the splat of each pair
  std::vector<std::vector<std::uint32_t>> place(chunks, std::vector<std::uint32_t>(tiles, 0));
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    if (job.cancelled()) return;
    for (std::size_t i = c * kBinChunk; i < std::min(order.size(), (c + 1) * kBinChunk); ++i)
      visit_tiles(grid->splats[order[i]], *grid, [&](int tile) {
        hits[c].push_back(static_cast<std::uint32_t>(tile));
        owner[c].push_back(order[i]);
        ++place[c][static_cast<std::size_t>(tile)];
      });
  });
  grid->first_entry.assign(tiles + 1, 0);
  std::uint32_t sum = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    grid->first_entry[t] = sum;
    for (std::size_t c = 0; c < chunks; ++c) sum += std::exchange(place[c][t], sum);
  }
  grid->first_entry[tiles] = sum;
  grid->entries.resize(sum);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    for (std::size_t i = 0; i < hits[c].size(); ++i) grid->entries[place[c][hits[c][i]]++] = owner[c][i];
  });
}

}  // namespace

TileGrid bin_splats(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options, const Job& job) {
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  TileGrid grid;
  grid.first_tile_x = roi.x0 / kTilePx;
  grid.first_tile_y = roi.y0 / kTilePx;
  grid.tiles_x = (roi.x1 + kTilePx - 1) / kTilePx - grid.first_tile_x;
  grid.tiles_y = (roi.y1 + kTilePx - 1) / kTilePx - grid.first_tile_y;
  project_all(cloud, camera, options, roi, job, &grid);
  fill_tiles(order_by_depth(grid.splats), job, &grid);
  return grid;
}

}  // namespace splatcut
