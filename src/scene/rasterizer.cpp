#include "scene/rasterizer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "scene/projected_view.h"
#include "scene/tile_blend.h"

namespace splatcut {

namespace {

RasterOutput empty_output(const RasterOptions& options, int width, int height) {
  RasterOutput out;
  if (options.colour) out.colour = Image<glm::vec3>(width, height);
  if (!options.labels.empty()) out.label_share = Image<float>(width, height);
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

PixelRect drawn_region(const Camera& camera, const RasterOptions& options) {
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  assert(roi.x0 >= 0 && roi.y0 >= 0 && roi.x1 <= camera.width_px && roi.y1 <= camera.height_px);
  return roi;
}

void check([[maybe_unused]] const GaussianCloud& cloud, [[maybe_unused]] const Camera& camera, [[maybe_unused]] const RasterOptions& options) {
  [[maybe_unused]] const auto fits = [&](std::size_t size) { return size == 0 || size == cloud.size(); };
  assert(fits(options.colour_override.size()) && fits(options.labels.size()) && fits(options.shown.size()));
  assert(options.labels.empty() || !options.colour);
  assert(!options.sums ||
         (options.sum_mask && options.sums->total.size() == cloud.size() &&
          options.sum_mask->width() == camera.width_px && options.sum_mask->height() == camera.height_px));
}

// whole: the grid holds more than is asked for.
RasterOutput draw_grid(const TileGrid& grid, const PixelRect& roi, bool whole, const RasterOptions& options, const Job& job) {
  RasterOutput out = empty_output(options, roi.width(), roi.height());
  out.visible = grid.visible;
  out.pairs = grid.entries.size();
  LargeArray<PairSums> pair_sums;
  if (options.sums) {
    pair_sums = LargeArray<PairSums>(grid.entries.size());
    if (whole && (options.roi || !options.shown.empty())) std::fill_n(pair_sums.data(), pair_sums.size(), PairSums{0, 0});
  }
  blend_tiles(grid, options, roi, whole ? options.shown : std::span<const std::uint8_t>(), job, options.sums ? pair_sums.data() : nullptr,
              &out);
  if (options.sums && !job.cancelled()) add_sums(grid, pair_sums, options.sums);
  return out;
}

}  // namespace

RasterOutput rasterize(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                       const Job& job) {
  check(cloud, camera, options);
  const PixelRect roi = drawn_region(camera, options);
  if (roi.empty()) return empty_output(options, roi.width(), roi.height());
  const TileGrid grid = bin_splats(cloud, camera, options, job);
  if (job.cancelled()) return empty_output(options, roi.width(), roi.height());
  return draw_grid(grid, roi, false, options, job);
}

struct ProjectedView::Grid : TileGrid {};

ProjectedView::ProjectedView(const GaussianCloud& cloud, const Camera& camera, bool coloured, const Job& job)
    : cloud_(cloud), camera_(camera), coloured_(coloured) {
  RasterOptions options;
  options.colour = coloured;
  Grid grid{bin_splats(cloud, camera, options, job)};
  if (!job.cancelled()) sort_tiles(&grid, job);
  if (!job.cancelled()) grid_ = std::make_unique<const Grid>(std::move(grid));
}

ProjectedView::~ProjectedView() = default;

std::size_t ProjectedView::bytes() const {
  if (!grid_) return 0;
  std::size_t bytes = grid_->splats.size() * sizeof(BlendSplat) + grid_->entries.size() * (sizeof(TileEntry) + sizeof(std::uint32_t));
  for (const std::vector<SplatTile>& run : grid_->runs) bytes += run.capacity() * sizeof(SplatTile);
  return bytes;
}

RasterOutput ProjectedView::draw(const RasterOptions& options, const Job& job) const {
  check(cloud_, camera_, options);
  assert(!options.near_plane && options.colour_override.empty() && (coloured_ || !options.colour));
  const PixelRect roi = drawn_region(camera_, options);
  if (roi.empty() || !grid_) return empty_output(options, roi.width(), roi.height());
  return draw_grid(*grid_, roi, true, options, job);
}

const char* rasterizer_simd_target() {
  return blend_simd_target();
}

}  // namespace splatcut
