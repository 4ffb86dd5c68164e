#include "scene/projected_view.h"

#include <algorithm>

// ProjectedView stands in rasterizer.cpp, beside rasterize(), with which it shares the drawing.

namespace splatcut {

const ProjectedView& KeptViews::view(const Camera& camera, bool coloured, const Job& job) {
  const auto found = std::ranges::find_if(views_, [&](const auto& v) { return same_camera(v->camera(), camera); });
  if (found != views_.end() && (*found)->complete() && ((*found)->coloured() || !coloured)) {
    std::rotate(found, found + 1, views_.end());
    return *views_.back();
  }
  if (found != views_.end()) views_.erase(found);
  views_.push_back(std::make_unique<ProjectedView>(cloud_, camera, coloured, job));
  std::size_t bytes = 0;
  for (const auto& v : views_) bytes += v->bytes();
  while (bytes > most_bytes_ && views_.size() > 1) {
    bytes -= views_.front()->bytes();
    views_.erase(views_.begin());
  }
  return *views_.back();
}

RasterOutput Drawer::draw(const Camera& camera, const RasterOptions& options, const Job& job) const {
  if (!kept_ || options.near_plane || !options.colour_override.empty()) return rasterize(*cloud_, camera, options, job);
  return kept_->view(camera, options.colour, job).draw(options, job);
}

}  // namespace splatcut
