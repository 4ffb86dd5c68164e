#include "segment/superpoints/superpoints.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/radix_sort.h"
#include "scene/raster/splat_math.h"
#include "segment/graphcut/k_nearest.h"

namespace splatcut {

namespace {

constexpr float kNoDistance = 1e-30f;  // less than any in a scene

float mahalanobis(const GaussianCloud& cloud, std::size_t g, std::size_t h) {
  glm::vec3 d = cloud.position[h] - cloud.position[g];
  glm::mat3 s = 0.5f * (covariance_world(cloud.scale[g], cloud.rotation[g]) +
                        covariance_world(cloud.scale[h], cloud.rotation[h]));
  // In a unit, a power of two, in which the determinant stays in range: the bits are those of any other.
  const float trace = s[0][0] + s[1][1] + s[2][2];
  const float unit = trace > 0 ? std::exp2(-std::floor(0.5f * static_cast<float>(std::ilogb(trace)))) : 1.0f;
  s *= unit * unit;
  d *= unit;
  const float ridge = 1e-3f * (s[0][0] + s[1][1] + s[2][2]) + 1e-30f;
  for (int i = 0; i < 3; ++i) s[i][i] += ridge;
  const float q = glm::dot(d, glm::inverse(s) * d);
  return q > 0 ? std::sqrt(q) : 0;
}

void measure(const GaussianCloud& cloud, const SurfaceFeatures& f, SurfaceEdge* e) {
  const glm::vec3 d = f.position_world[e->b] - f.position_world[e->a];
  const float distance = std::max(glm::length(d), kNoDistance);
  const glm::vec3 &n = f.normal_world[e->a], &m = f.normal_world[e->b];
  e->colour = glm::length(f.colour[e->a] - f.colour[e->b]);
  e->normal = 1 - glm::dot(n, m);
  e->concavity = glm::dot(n - m, d) / distance;
  e->gap = mahalanobis(cloud, f.core[e->a], f.core[e->b]);
  e->length = std::sqrt(f.spacing[e->a] * f.spacing[e->b]);
  e->distance = distance / std::max(e->length, kNoDistance);
}

float weight_of(const SurfaceEdge& e, const SuperpointOptions& o) {
  return e.colour / o.colour_unit + o.normal * e.normal + o.concavity * std::max(0.0f, e.concavity) +
         o.gap * std::min(o.gap_most, o.gap_unit * e.gap) + o.distance * e.distance;
}

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n), size_(n, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::uint32_t size(std::uint32_t root) const { return size_[root]; }
  std::uint32_t join(std::uint32_t a, std::uint32_t b) {
    if (size_[a] < size_[b]) std::swap(a, b);
    parent_[b] = a;
    size_[a] += size_[b];
    return a;
  }

 private:
  std::vector<std::uint32_t> parent_, size_;
};

std::vector<KeyValue<std::uint32_t>> by_weight(std::span<const SurfaceEdge> edges,
                                               const SuperpointOptions& options) {
  std::vector<KeyValue<std::uint32_t>> order(edges.size()), scratch(edges.size());
  for (std::uint32_t i = 0; i < edges.size(); ++i)
    // Weights >= 0 sort as bits. Between equal normals rounding may leave less.
    order[i] = {std::bit_cast<std::uint32_t>(std::max(0.0f, weight_of(edges[i], options))), i};
  radix_sort<11>(std::span(order), std::span(scratch), 0, 32);
  return order;
}

}  // namespace

std::vector<SurfaceEdge> surface_edges(const GaussianCloud& cloud, const SurfaceFeatures& f) {
  std::vector<SurfaceEdge> edges;
  edges.reserve(f.core.size() * f.k * 2 / 3);
  const auto lists = [&](std::uint32_t i, std::uint32_t j) {
    const auto first = f.neighbour.begin() + static_cast<std::ptrdiff_t>(i * f.k);
    return std::find(first, first + static_cast<std::ptrdiff_t>(f.k), j) !=
           first + static_cast<std::ptrdiff_t>(f.k);
  };
  for (std::uint32_t i = 0; i < f.core.size(); ++i)
    for (std::size_t e = i * f.k; e < (i + 1) * f.k; ++e) {
      const std::uint32_t j = f.neighbour[e];
      if (j != kNoNeighbour && (i < j || !lists(j, i))) edges.push_back({std::min(i, j), std::max(i, j)});
    }
  for_each_index(edges.size(), [&](std::size_t i) { measure(cloud, f, &edges[i]); });
  return edges;
}

Superpoints superpoints(const SurfaceFeatures& f, std::span<const SurfaceEdge> edges,
                        const SuperpointOptions& options) {
  const std::size_t n = f.core.size();
  UnionFind sets(n);
  std::vector<float> internal(n);  // largest weight inside a superpoint
  const auto order = by_weight(edges, options);
  for (const auto& [key, i] : order) {
    const std::uint32_t a = sets.find(edges[i].a), b = sets.find(edges[i].b);
    if (a == b || sets.size(a) + sets.size(b) > options.cap) continue;
    const float w = std::bit_cast<float>(key);
    if (w > std::min(internal[a] + options.k / static_cast<float>(sets.size(a)),
                     internal[b] + options.k / static_cast<float>(sets.size(b))))
      continue;
    internal[sets.join(a, b)] = w;
  }
  for (const auto& [key, i] : order) {
    const std::uint32_t a = sets.find(edges[i].a), b = sets.find(edges[i].b);
    if (a != b && std::min(sets.size(a), sets.size(b)) < options.least) sets.join(a, b);
  }
  Superpoints out;
  out.of.assign(n, kNoPart);
  std::vector<std::uint32_t> name(n, kNoPart);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t& id = name[sets.find(i)];
    if (id == kNoPart) id = out.count++;
    out.of[i] = id;
  }
  return out;
}

}  // namespace splatcut
