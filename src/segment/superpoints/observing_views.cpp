#include "segment/superpoints/observing_views.h"

#include <algorithm>

#include "core/ranks.h"
#include "scene/raster/rasterizer.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

// Median depth in the middle of the picture; 0 where nothing is.
float depth_looked_at(const GaussianCloud& cloud, const Camera& camera, const Job& job) {
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  const RasterOutput out = rasterize(cloud, camera, options, job);
  std::vector<float> depths;
  for (int y = camera.height_px / 4; y < camera.height_px * 3 / 4; ++y)
    for (int x = camera.width_px / 4; x < camera.width_px * 3 / 4; ++x)
      if (out.first_hit.at(x, y) >= 0) depths.push_back(out.expected_depth.at(x, y));
  return median(std::move(depths));
}

}  // namespace

std::vector<Camera> observing_views(const GaussianCloud& cloud, const Camera& reference,
                                    const glm::vec3& up_world, std::span<const Camera> given,
                                    const ObservingOptions& options, const Job& job) {
  std::vector<Camera> views{limited_to_width(reference, options.width_px)};
  const std::size_t n = std::min<std::size_t>(given.size(), static_cast<std::size_t>(options.most_given));
  for (std::size_t i = 0; i < n; ++i)
    views.push_back(limited_to_width(given[i * given.size() / n], options.width_px));
  if (n > 0) return views;
  const float depth = depth_looked_at(cloud, views.front(), job);
  if (!(depth > 0)) return views;
  OrbitOptions orbit;
  orbit.views = options.ring;
  orbit.elevation_swing_rad = options.elevation_swing_rad;
  const glm::vec3 target = views.front().world_from_pixel({views.front().cx_px, views.front().cy_px}, depth);
  const ObjectExtent at_that_distance{target, depth / (2 * orbit.distance_sizes)};
  std::ranges::copy(orbit_cameras(views.front(), up_world, at_that_distance, orbit),
                    std::back_inserter(views));
  return views;
}

}  // namespace splatcut
