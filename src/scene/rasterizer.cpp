#include "scene/rasterizer.h"

#include <tbb/parallel_for.h>

#include <cassert>

#include "scene/tile_blend.h"
#include "scene/tile_grid.h"

namespace splatcut {

namespace {

RasterOutput empty_output(const RasterOptions& options, int width, int height) {
  RasterOutput out;
  if (options.colour) out.colour = Image<glm::vec3>(width, height);
  out.alpha = Image<float>(width, height);
  if (options.depth) {
    out.expected_depth = out.median_depth = Image<float>(width, height);
    out.first_hit = Image<std::int32_t>(width, height, -1);
  }
  return out;
}

// Every Gaussian collects what its tiles have added, so no two threads write to the same sum.
void add_sums(const TileGrid& grid, const LargeArray<PairSums>& pair_sums, MaskedSums* sums) {
  tbb::parallel_for(std::size_t{0}, grid.runs.size(), [&](std::size_t run) {
    for (const SplatTile& pair : grid.runs[run]) {
      const PairSums& added = pair_sums[pair.entry];
      sums->total[pair.gaussian] += added.total;
      sums->inside[pair.gaussian] += added.inside;
    }
  });
}

}  // namespace

RasterOutput rasterize(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                       const Job& job) {
  assert(options.colour_override.empty() || options.colour_override.size() == cloud.size());
  assert(options.shown.empty() || options.shown.size() == cloud.size());
  assert(!options.sums ||
         (options.sum_mask && options.sums->total.size() == cloud.size() &&
          options.sum_mask->width() == camera.width_px && options.sum_mask->height() == camera.height_px));
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  assert(roi.x0 >= 0 && roi.y0 >= 0 && roi.x1 <= camera.width_px && roi.y1 <= camera.height_px);
  RasterOutput out = empty_output(options, roi.width(), roi.height());
  if (roi.empty()) return out;
  const TileGrid grid = bin_splats(cloud, camera, options, job);
  if (job.cancelled()) return out;
  out.visible = grid.visible;
  out.pairs = grid.entries.size();
  LargeArray<PairSums> pair_sums;
  if (options.sums) pair_sums = LargeArray<PairSums>(grid.entries.size());
  blend_tiles(grid, options, roi, job, options.sums ? pair_sums.data() : nullptr, &out);
  if (options.sums && !job.cancelled()) add_sums(grid, pair_sums, options.sums);
  return out;
}

const char* rasterizer_simd_target() {
  return blend_simd_target();
}

}  // namespace splatcut
