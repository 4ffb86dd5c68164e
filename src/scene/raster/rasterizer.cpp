#include "scene/raster/rasterizer.h"

#include "scene/raster/grid_drawing.h"
#include "scene/raster/tile_blend.h"

namespace splatcut {

namespace {

// Where the border between two halves of tiles lies, or end where there is but one.
int middle(int begin, int end) {
  const int first = begin / kTilePx, tiles = (end + kTilePx - 1) / kTilePx - first;
  return tiles < 2 ? end : (first + tiles / 2) * kTilePx;
}

// In halves where the grid would be too large.
void draw_region(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                 const PixelRect& region, const PixelRect& roi, const Job& job, RasterOutput* out) {
  if (job.cancelled()) return;
  RasterOptions part = options;
  part.roi = region;
  {
    const TileGrid grid = bin_splats(cloud, camera, part, job);
    if (job.cancelled()) return;
    if (!grid.too_large) return draw_grid(grid, roi, options, job, out);
  }
  PixelRect first = region, second = region;
  first.y1 = second.y0 = middle(region.y0, region.y1);
  if (second.empty()) {
    first = second = region;
    first.x1 = second.x0 = middle(region.x0, region.x1);
  }
  for (const PixelRect& half : {first, second}) draw_region(cloud, camera, options, half, roi, job, out);
}

}  // namespace

std::uint32_t group_of_pixel(std::span<const GroupWeight> heaviest_first) {
  constexpr float kCovered = 0.5f;
  float all = 0;
  for (const GroupWeight& w : heaviest_first) all += w.weight;
  return all >= kCovered ? heaviest_first.front().group : kNoGroup;
}

RasterOutput rasterize(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                       const Job& job) {
  const PixelRect roi = drawn_region(cloud, camera, options);
  if (roi.empty()) return empty_output(options, roi);
  RasterOutput out = empty_output(options, roi);
  draw_region(cloud, camera, options, roi, roi, job, &out);
  return out;
}

}  // namespace splatcut
