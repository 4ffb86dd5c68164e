#include "segment/superpoints/observation.h"

#include <utility>

#include "core/parallel.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

Observation observe(const GaussianCloud& cloud, std::span<const Camera> views, const Job& job) {
  Observation o{std::vector<float>(cloud.size(), 0), std::vector<glm::vec3>(cloud.size(), glm::vec3(0)), {}};
  for (const Camera& view : views) {
    if (job.cancelled()) break;
    const Mask everything(view.width_px, view.height_px, kMaskObject);
    MaskedSums sums(cloud.size());
    RasterOptions raster;
    raster.colour = false;
    raster.depth = true;
    raster.sum_mask = &everything;
    raster.sums = &sums;
    RasterOutput drawn = rasterize(cloud, view, raster, job);
    o.pictures.push_back({std::move(drawn.first_hit), std::move(drawn.expected_depth)});
    const glm::vec3 centre = view.centre_world();
    for_each_index(cloud.size(), [&](std::size_t g) {
      if (sums.total[g] == 0) return;
      const float seen = static_cast<float>(static_cast<double>(sums.total[g]) / MaskedSums::kUnitsPerPixel);
      o.seen_px[g] += seen;
      o.towards_views[g] += seen * glm::normalize(centre - cloud.position[g]);
    });
  }
  return o;
}

}  // namespace splatcut
