#include "segment/session/correction.h"

#include <algorithm>

#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

Strokes swapped(const Strokes& strokes) {
  Strokes out = strokes;
  for (Stroke& s : out) s.label = s.label == SeedLabel::kObject ? SeedLabel::kRest : SeedLabel::kObject;
  return out;
}

}  // namespace

Correction corrected(const Drawer& drawer, const StrokedView& view, const std::vector<std::uint8_t>& labels,
                     const CutSettings& settings, const Job& job) {
  Correction out;
  out.camera = limited_to_width(view.camera, settings.work_width_px);
  const int width = out.camera.width_px, height = out.camera.height_px;
  const Strokes here =
      scaled(view.strokes, static_cast<float>(width) / static_cast<float>(view.camera.width_px));
  RasterOptions raster;
  raster.depth = true;
  const RasterOutput drawn = drawer.draw(out.camera, raster, job);
  const Image<Rgb8> picture = rgb8_from_linear(drawn.colour);
  const Mask prior = thresholded(render_labels(drawer, out.camera, labels, job), 0.5f);
  const auto grown_from = [&](const Strokes& strokes, SeedLabel wanted) {
    const bool any = std::ranges::any_of(strokes, [&](const Stroke& s) { return s.label == wanted; });
    if (!any || job.cancelled()) return Mask(width, height);
    return first_mask(picture, drawn.expected_depth,
                      wanted == SeedLabel::kObject ? strokes : swapped(strokes), settings.first_mask, job);
  };
  const Mask plus = grown_from(here, SeedLabel::kObject), minus = grown_from(here, SeedLabel::kRest);
  const Image<std::uint8_t> seeds = draw_seeds(here, width, height);
  out.mask = out.added = out.removed = Mask(width, height);
  for (std::size_t i = 0; i < prior.size(); ++i) {
    bool object = (prior.pixels()[i] || plus.pixels()[i]) && !minus.pixels()[i];
    if (seeds.pixels()[i] != kNoSeed) object = seeds.pixels()[i] == kObjectSeed;
    out.mask.pixels()[i] = object ? kMaskObject : 0;
    // Strokes count as changes where they confirm, too: later views must not undo them.
    if (object && (!prior.pixels()[i] || seeds.pixels()[i] == kObjectSeed))
      out.added.pixels()[i] = kMaskObject;
    if (!object && (prior.pixels()[i] || seeds.pixels()[i] == kRestSeed))
      out.removed.pixels()[i] = kMaskObject;
  }
  return out;
}

void add_weighted(const Drawer& drawer, const Correction& correction, std::int64_t weight, bool whole_pixels,
                  const Job& job, MaskedSums* sums) {
  const std::size_t n = drawer.cloud().size();
  MaskedSums added(n), removed(n);
  add_masked_sums(drawer, correction.camera, correction.added, whole_pixels, job, &added);
  add_masked_sums(drawer, correction.camera, correction.removed, whole_pixels, job, &removed);
  for (std::size_t g = 0; g < n; ++g) {
    sums->total[g] += weight * (added.inside[g] + removed.inside[g]);
    sums->inside[g] += weight * added.inside[g];
  }
}

}  // namespace splatcut
