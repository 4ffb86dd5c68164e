#include "scene/raster/grid_drawing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace splatcut {

namespace {

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

void add_planes(const TileGrid& grid, const LargeArray<std::int32_t>& plane_sums, PlaneSums* sums) {
  const std::size_t planes = sums->planes();
  tbb::parallel_for(std::size_t{0}, grid.runs.size(), [&](std::size_t run) {
    for (const SplatTile& pair : grid.runs[run])
      for (std::size_t k = 0; k < planes; ++k)
        sums->sum[pair.gaussian * planes + k] += plane_sums[pair.entry * planes + k];
  });
}

void check_sizes([[maybe_unused]] const GaussianCloud& cloud, [[maybe_unused]] const Camera& camera,
                 [[maybe_unused]] const RasterOptions& options) {
  [[maybe_unused]] const auto fits = [&](std::size_t size) { return size == 0 || size == cloud.size(); };
  assert(fits(options.colour_override.size()) && fits(options.labels.size()) && fits(options.shown.size()));
  assert(!options.blocks || options.blocks->gaussians() == cloud.size());
  assert((options.colour || !options.groups.empty()) + !options.labels.empty() + options.list_gaussians <= 1);
  assert(!options.plane_sums ||
         (options.sum_planes.size() == options.plane_sums->planes() &&
          options.sum_planes.size() <= PlaneSums::kMost &&
          options.plane_sums->sum.size() == cloud.size() * options.plane_sums->planes() && !options.sums &&
          !options.colour && !options.depth && options.labels.empty() && options.groups.empty() &&
          !options.list_gaussians));
  assert(!options.sums ||
         (options.sum_mask && options.sums->total.size() == cloud.size() &&
          options.sum_mask->width() == camera.width_px && options.sum_mask->height() == camera.height_px));
}

// partly: not all entries of the grid are drawn.
void draw(TileBlend what, bool partly, const Job& job, RasterOutput* out) {
  const RasterOptions& options = what.options;
  LargeArray<PairSums> pair_sums;
  if (options.sums) {
    pair_sums = LargeArray<PairSums>(what.grid.entries.size());
    if (partly) std::fill_n(pair_sums.data(), pair_sums.size(), PairSums{0, 0});
    what.pair_sums = pair_sums.data();
  }
  LargeArray<std::int32_t> plane_sums;
  if (options.plane_sums) {
    plane_sums = LargeArray<std::int32_t>(what.grid.entries.size() * options.plane_sums->planes());
    std::fill_n(plane_sums.data(), plane_sums.size(), 0);
    what.plane_sums = plane_sums.data();
  }
  blend_tiles(what, job, out);
  if (options.plane_sums && !job.cancelled()) add_planes(what.grid, plane_sums, options.plane_sums);
  if (options.sums && !job.cancelled()) add_sums(what.grid, pair_sums, options.sums);
}

}  // namespace

RasterOutput empty_output(const RasterOptions& options, const PixelRect& roi) {
  const int width = roi.width(), height = roi.height();
  RasterOutput out;
  if (options.colour) out.colour = Image<glm::vec3>(width, height);
  if (!options.labels.empty()) out.label_share = Image<float>(width, height);
  if (!options.groups.empty()) out.group = Image<std::uint32_t>(width, height, kNoGroup);
  if (options.list_gaussians) {
    out.gaussians.of = Image<std::span<GroupWeight>>(width, height);
    out.gaussians.memory.resize(tiles_of(roi).size());
  }
  out.alpha = Image<float>(width, height);
  if (options.depth) {
    out.expected_depth = out.median_depth = Image<float>(width, height);
    out.first_hit = Image<std::int32_t>(width, height, -1);
  }
  return out;
}

PixelRect drawn_region(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options) {
  check_sizes(cloud, camera, options);
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  assert(roi.x0 >= 0 && roi.y0 >= 0 && roi.x1 <= camera.width_px && roi.y1 <= camera.height_px);
  return roi;
}

void draw_grid(const TileGrid& grid, const PixelRect& roi, const RasterOptions& options, const Job& job,
               RasterOutput* out) {
  draw({.grid = grid, .options = options, .roi = roi, .shown = {}}, false, job, out);
}

RasterOutput draw_kept_grid(KeptGrid* kept, const PixelRect& roi, const RasterOptions& options,
                            const Job& job) {
  const PixelRect& all = kept->picture;
  const bool everything = roi.x0 == all.x0 && roi.y0 == all.y0 && roi.x1 == all.x1 && roi.y1 == all.y1;
  RasterOutput out = empty_output(options, roi);
  draw({.grid = kept->grid,
        .options = options,
        .roi = roi,
        .shown = options.shown,
        .lists = &kept->lists,
        .picture = all},
       !everything || !options.shown.empty(), job, &out);
  return out;
}

}  // namespace splatcut
