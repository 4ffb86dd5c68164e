// The rasteriser's maths one pixel and one Gaussian at a time, slow and readable: what rasterize() is
// compared with. Differs from it by rounding only.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"

namespace splatcut::testing {

struct DepthSplat {
  Splat splat;
  std::uint32_t gaussian;
  glm::vec3 colour;
};

inline std::vector<DepthSplat> front_to_back(const GaussianCloud& cloud, const Camera& camera,
                                             const RasterOptions& options) {
  std::vector<DepthSplat> splats;
  const glm::vec3 eye_world = camera.centre_world();
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    if (!options.shown.empty() && !options.shown[g]) continue;
    DepthSplat s{{}, static_cast<std::uint32_t>(g), {}};
    if (!project(cloud, g, camera, options.near_plane.value_or(cloud.near_plane), &s.splat,
                 options.low_pass_px2))
      continue;
    s.colour = options.colour_override.empty()
                   ? sh_colour(cloud.f_dc[g], cloud.sh_rest_of(g), cloud.sh_degree,
                               glm::normalize(cloud.position[g] - eye_world))
                   : options.colour_override[g];
    splats.push_back(s);
  }
  std::stable_sort(splats.begin(), splats.end(),
                   [](const DepthSplat& a, const DepthSplat& b) { return a.splat.depth < b.splat.depth; });
  return splats;
}

inline float alpha_at(const Splat& splat, const glm::vec2& pixel) {
  const glm::vec2 d = pixel - splat.mean_px;
  const float q = splat.conic.a * d.x * d.x + 2 * splat.conic.b * d.x * d.y + splat.conic.c * d.y * d.y;
  return std::min(kAlphaMax, splat.opacity * std::exp(-0.5f * q));
}

inline RasterOutput rasterize_reference(const GaussianCloud& cloud, const Camera& camera,
                                        const RasterOptions& options = {}) {
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  RasterOutput out;
  if (options.colour) out.colour = Image<glm::vec3>(roi.width(), roi.height());
  out.alpha = Image<float>(roi.width(), roi.height());
  if (!options.labels.empty()) out.label_share = Image<float>(roi.width(), roi.height());
  if (options.depth) {
    out.expected_depth = out.median_depth = Image<float>(roi.width(), roi.height());
    out.first_hit = Image<std::int32_t>(roi.width(), roi.height(), -1);
  }
  const std::vector<DepthSplat> splats = front_to_back(cloud, camera, options);
  for (int y = roi.y0; y < roi.y1; ++y)
    for (int x = roi.x0; x < roi.x1; ++x) {
      const int ox = x - roi.x0, oy = y - roi.y0;
      float transmittance = 1, weighted_depth = 0;
      glm::vec3 colour(0);
      for (const DepthSplat& s : splats) {
        const float alpha = alpha_at(s.splat, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
        if (!(alpha >= kAlphaMin)) continue;
        const float weight = alpha * transmittance;
        colour += weight * s.colour;
        weighted_depth += weight * s.splat.depth;
        if (!options.labels.empty() && options.labels[s.gaussian]) out.label_share.at(ox, oy) += weight;
        if (options.sums) {
          const auto units =
              std::llrint((options.sum_whole_pixels ? 1 : weight) * MaskedSums::kUnitsPerPixel);
          options.sums->total[s.gaussian] += units;
          if (options.sum_mask->at(x, y)) options.sums->inside[s.gaussian] += units;
        }
        for (std::size_t k = 0; options.plane_sums && k < options.sum_planes.size(); ++k)
          options.plane_sums->sum[s.gaussian * options.sum_planes.size() + k] +=
              std::llrint(weight * options.sum_planes[k].at(ox, oy) * MaskedSums::kUnitsPerPixel);
        const float before = transmittance;
        transmittance -= weight;
        if (options.depth && before >= 0.5f && transmittance < 0.5f) {
          out.median_depth.at(ox, oy) = s.splat.depth;
          out.first_hit.at(ox, oy) = static_cast<std::int32_t>(s.gaussian);
        }
        if (transmittance < kTransmittanceStop) break;
      }
      out.alpha.at(ox, oy) = 1 - transmittance;
      if (options.colour) out.colour.at(ox, oy) = colour + transmittance * options.background;
      if (options.depth && transmittance < 1)
        out.expected_depth.at(ox, oy) = weighted_depth / (1 - transmittance);
    }
  return out;
}

}  // namespace splatcut::testing
