#include "scene/raster/block_view.h"

#include <algorithm>
#include <cmath>

#include "scene/raster/splat_projection.h"

namespace splatcut {

BlockView::BlockView(const Camera& camera, float near_plane, float low_pass_px2, const PixelRect& region) {
  const glm::dmat3 rotation(camera.camera_from_world_rotation);
  const glm::dvec3 t(camera.camera_from_world_translation);
  const auto row = [&](int i) { return glm::dvec3(rotation[0][i], rotation[1][i], rotation[2][i]); };
  const double low_pass = kCutoffSigmas * std::sqrt(static_cast<double>(low_pass_px2));
  sides_[0] = {row(2), t.z - near_plane, 0};
  // sign: +1 for the low side of the region, along which positions grow away from it.
  const auto side = [&](int axis, double focal, double centre, double edge, int size_px, double sign) {
    const double limit = kFrustumSlack * 0.5 * size_px / focal;
    const double reach = kCutoffSigmas * std::sqrt(1 + limit * limit);
    const double slope = edge - centre - sign * low_pass;
    return Side{sign * (focal * row(axis) - slope * row(2)), sign * (focal * t[axis] - slope * t.z),
                focal * reach};
  };
  const int w = camera.width_px, h = camera.height_px;
  sides_[1] = side(0, camera.fx_px, camera.cx_px, region.x0, w, 1);
  sides_[2] = side(0, camera.fx_px, camera.cx_px, region.x1, w, -1);
  sides_[3] = side(1, camera.fy_px, camera.cy_px, region.y0, h, 1);
  sides_[4] = side(1, camera.fy_px, camera.cy_px, region.y1, h, -1);
}

bool BlockView::may_show(const CloudBlock& block) const {
  constexpr double kRounding = 1e-4;  // of the terms: projection rounds to float
  const glm::dvec3 centre(block.centres_world.centre()), half(0.5 * glm::dvec3(block.centres_world.extent()));
  return std::ranges::all_of(sides_, [&](const Side& s) {
    const double across = glm::dot(glm::abs(s.normal_world), half), sigma = s.per_sigma * block.longest_sigma;
    const double at = glm::dot(s.normal_world, centre);
    const double slack = kRounding * (std::abs(at) + std::abs(s.constant) + across + sigma);
    return at + s.constant + across + sigma + slack >= 0;
  });
}

}  // namespace splatcut
