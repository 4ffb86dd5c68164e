#include "scene/raster/projected_view.h"

#include <algorithm>
#include <cassert>

#include "scene/raster/grid_drawing.h"

namespace splatcut {

ProjectedView::ProjectedView(const GaussianCloud& cloud, const Camera& camera, bool coloured, const Job& job,
                             std::size_t most_pairs)
    : cloud_(cloud), camera_(camera), coloured_(coloured) {
  RasterOptions options;
  options.colour = coloured;
  options.most_pairs = most_pairs;
  KeptGrid kept{.grid = bin_splats(cloud, camera, options, job),
                .picture = {0, 0, camera.width_px, camera.height_px},
                .lists = {}};
  too_large_ = kept.grid.too_large && !job.cancelled();
  if (too_large_) return;
  if (!job.cancelled()) sort_tiles(&kept.grid, job);
  if (job.cancelled()) return;
  kept.lists.resize(static_cast<std::size_t>(kept.grid.tiles()));
  grid_ = std::make_unique<KeptGrid>(std::move(kept));
}

ProjectedView::~ProjectedView() = default;

std::size_t ProjectedView::bytes() const {
  if (!grid_) return 0;
  const TileGrid& grid = grid_->grid;
  std::size_t bytes = grid.splats.size() * sizeof(BlendSplat) +
                      grid.entries.size() * (sizeof(TileEntry) + sizeof(std::uint32_t));
  for (const std::vector<SplatTile>& run : grid.runs) bytes += run.capacity() * sizeof(SplatTile);
  for (const TileLists& lists : grid_->lists)
    bytes += lists.splat.capacity() + lists.count.capacity() * sizeof(std::uint16_t);
  return bytes;
}

RasterOutput ProjectedView::draw(const RasterOptions& options, const Job& job) const {
  assert(!options.near_plane && options.low_pass_px2 == kLowPassPx2 && options.colour_override.empty() &&
         (coloured_ || !options.colour));
  if (too_large_) return rasterize(cloud_, camera_, options, job);
  const PixelRect roi = drawn_region(cloud_, camera_, options);
  if (roi.empty() || !grid_) return empty_output(options, roi);
  return draw_kept_grid(grid_.get(), roi, options, job);
}

std::size_t KeptViews::bytes() const {
  std::size_t bytes = 0;
  for (const auto& view : views_) bytes += view->bytes();
  return bytes;
}

const ProjectedView& KeptViews::view(const Camera& camera, bool coloured, const Job& job) {
  const auto found =
      std::ranges::find_if(views_, [&](const auto& v) { return same_picture(v->camera(), camera); });
  if (found != views_.end() && (*found)->complete() && ((*found)->coloured() || !coloured)) {
    std::rotate(found, found + 1, views_.end());
    return *views_.back();
  }
  if (found != views_.end()) views_.erase(found);
  views_.push_back(std::make_unique<ProjectedView>(cloud_, camera, coloured, job));
  for (std::size_t all = bytes(); all > most_bytes_ && views_.size() > 1;) {
    all -= views_.front()->bytes();
    views_.erase(views_.begin());
  }
  return *views_.back();
}

RasterOutput Drawer::draw(const Camera& camera, const RasterOptions& options, const Job& job) const {
  const bool by_kept =
      kept_ && !options.near_plane && options.low_pass_px2 == kLowPassPx2 && options.colour_override.empty();
  if (by_kept) return kept_->view(camera, options.colour, job).draw(options, job);
  RasterOptions past_blocks = options;
  if (blocks_) past_blocks.blocks = blocks_;
  return rasterize(*cloud_, camera, past_blocks, job);
}

}  // namespace splatcut
