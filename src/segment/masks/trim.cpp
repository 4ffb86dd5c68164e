#include "segment/masks/trim.h"

#include <algorithm>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// Where the object may be: its mask, and where something nearer hides it.
Mask allowed_in(const Drawer& drawer, const TrimView& view, const TrimOptions& options,
                const std::vector<std::uint8_t>& labels, const PixelRect& rect, const Job& job) {
  RasterOptions raster;
  raster.colour = false;
  raster.depth = true;
  raster.roi = rect;
  Image<float> drawn;
  if (!view.scene_depth) drawn = drawer.draw(view.camera, raster, job).median_depth;
  const auto scene_depth = [&](int x, int y) {
    return view.scene_depth ? view.scene_depth->at(x, y) : drawn.at(x - rect.x0, y - rect.y0);
  };
  raster.shown = labels;
  const RasterOutput alone = drawer.draw(view.camera, raster, job);
  Mask allowed = dilated(*view.mask, options.margin_px);
  constexpr float kNearer = 0.99f;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) {
      const float depth = scene_depth(x, y);
      if (depth > 0 && depth < kNearer * alone.expected_depth.at(x - rect.x0, y - rect.y0))
        allowed.at(x, y) = kMaskObject;
    }
  return allowed;
}

}  // namespace

std::size_t trim(const Drawer& drawer, std::span<const TrimView> views, const TrimOptions& options,
                 std::vector<std::uint8_t>* labels, const Job& job) {
  MaskedSums sums(drawer.cloud().size());
  const std::size_t n = std::min(views.size(), static_cast<std::size_t>(options.most_views));
  for (std::size_t i = 0; i < n; ++i) {
    const TrimView& view = views[i * views.size() / n];
    if (job.cancelled()) return 0;
    const PixelRect rect = labelled_rectangle(drawer.cloud(), view.camera, *labels);
    if (rect.empty()) continue;
    const Mask allowed = allowed_in(drawer, view, options, *labels, rect, job);
    RasterOptions raster;
    raster.roi = rect;
    raster.colour = false;
    raster.shown = *labels;
    raster.sum_mask = &allowed;
    raster.sums = &sums;
    drawer.draw(view.camera, raster, job);
  }
  std::size_t left = 0;
  for (std::size_t g = 0; g < labels->size(); ++g) {
    if (!(*labels)[g] || sums.total[g] == 0) continue;
    if (static_cast<double>(sums.inside[g]) >= options.least_inside * static_cast<double>(sums.total[g]))
      continue;
    (*labels)[g] = 0;
    ++left;
  }
  return left;
}

}  // namespace splatcut
