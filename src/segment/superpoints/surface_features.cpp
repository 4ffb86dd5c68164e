#include "segment/superpoints/surface_features.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/ranks.h"
#include "scene/raster/splat_math.h"
#include "segment/graphcut/k_nearest.h"

namespace splatcut {

namespace {

struct Observation {
  std::vector<float> seen_px;            // A_g over all views
  std::vector<glm::vec3> towards_views;  // sum of A_g times the direction to the view's centre
};

Observation observe(const Drawer& drawer, std::span<const Camera> views, const Job& job) {
  const GaussianCloud& cloud = drawer.cloud();
  Observation o{std::vector<float>(cloud.size(), 0), std::vector<glm::vec3>(cloud.size(), glm::vec3(0))};
  for (const Camera& view : views) {
    if (job.cancelled()) break;
    const Mask nothing(view.width_px, view.height_px);  // of the sums only the totals are read
    MaskedSums sums(cloud.size());
    RasterOptions raster;
    raster.colour = false;
    raster.sum_mask = &nothing;
    raster.sums = &sums;
    drawer.draw(view, raster, job);
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

float largest_sigma(const glm::vec3& scale) {
  return std::max({scale.x, scale.y, scale.z});
}

std::vector<std::uint32_t> core_of(const GaussianCloud& cloud, const Observation& seen, bool observed,
                                   const SurfaceOptions& options) {
  std::vector<float> size(cloud.size());
  for_each_index(cloud.size(), [&](std::size_t g) { size[g] = largest_sigma(cloud.scale[g]); });
  std::vector<float> by_rank = size;
  const float too_large = quantile(&by_rank, options.size_quantile);
  std::vector<std::uint32_t> core;
  for (std::uint32_t g = 0; g < cloud.size(); ++g)
    if (cloud.opacity[g] > options.least_opacity && size[g] <= too_large &&
        (!observed || seen.seen_px[g] > options.least_seen_px))
      core.push_back(g);
  return core;
}

// Averages over the neighbours, `weight(i, j)` each, itself with 1.
template <class Value, class Weight>
std::vector<Value> averaged(const std::vector<Value>& value, const SurfaceFeatures& f, const Weight& weight) {
  std::vector<Value> out(value.size());
  for_each_index(value.size(), [&](std::size_t i) {
    Value sum = value[i];
    float total = 1;
    for (std::size_t e = i * f.k; e < (i + 1) * f.k; ++e) {
      const std::uint32_t j = f.neighbour[e];
      if (j == kNoNeighbour) break;
      const float w = weight(i, j);
      sum += w * value[j];
      total += std::abs(w);
    }
    out[i] = sum / total;
  });
  return out;
}

void smooth_normals(const SurfaceFeatures& f, int rounds, std::vector<glm::vec3>* normal) {
  for (int round = 0; round < rounds; ++round) {
    auto next = averaged(*normal, f, [&](std::size_t i, std::size_t j) {
      return glm::dot((*normal)[i], (*normal)[j]) < 0 ? -1.0f : 1.0f;
    });
    for_each_index(next.size(), [&](std::size_t i) {
      const float length = glm::length(next[i]);
      (*normal)[i] = length > 1e-6f ? next[i] / length : (*normal)[i];
    });
  }
}

}  // namespace

SurfaceFeatures surface_features(const Drawer& drawer, std::span<const Camera> observing,
                                 const SurfaceOptions& options, const Job& job) {
  const GaussianCloud& cloud = drawer.cloud();
  const Observation seen = observe(drawer, observing, job);
  SurfaceFeatures f;
  f.core = core_of(cloud, seen, !observing.empty(), options);
  const std::size_t n = f.core.size();
  f.position_world.resize(n);
  f.normal_world.resize(n);
  f.colour.resize(n);
  f.spacing.resize(n);
  for_each_index(n, [&](std::size_t i) {
    f.position_world[i] = cloud.position[f.core[i]];
    f.colour[i] = glm::vec3(0.5f) + kShC0 * cloud.f_dc[f.core[i]];
    f.normal_world[i] = shortest_axis(cloud.scale[f.core[i]], cloud.rotation[f.core[i]]);
  });
  f.k = std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), n > 0 ? n - 1 : 0);
  f.neighbour = k_nearest(f.position_world, f.k, job);
  if (job.cancelled()) return f;
  for_each_index(n, [&](std::size_t i) {
    const std::uint32_t last = f.k ? f.neighbour[(i + 1) * f.k - 1] : kNoNeighbour;
    if (last == kNoNeighbour) return;
    f.spacing[i] = glm::distance(f.position_world[i], f.position_world[last]) *
                   std::sqrt(3.14159265f / static_cast<float>(f.k));
  });
  for (int round = 0; round < options.colour_rounds; ++round)
    f.colour = averaged(f.colour, f, [&](std::size_t i, std::size_t j) {
      const glm::vec3 d = f.colour[i] - f.colour[j];
      return std::exp(-glm::dot(d, d) / (2 * options.like_colour * options.like_colour));
    });
  smooth_normals(f, options.normal_rounds, &f.normal_world);
  for_each_index(n, [&](std::size_t i) {
    if (glm::dot(f.normal_world[i], seen.towards_views[f.core[i]]) < 0)
      f.normal_world[i] = -f.normal_world[i];
  });
  return f;
}

}  // namespace splatcut
