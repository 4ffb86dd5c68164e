// Our neighbour term: psi = exp(-gamma_position D - gamma_colour |dbeta|^2), where
//   D = 1/4 d^T S^-1 d + ln(det S / sqrt(det Sigma_g det Sigma_h)),  S = (Sigma_g + Sigma_h) / 2,
// twice the Bhattacharyya distance of the two Gaussians, which needs no scene scale (1e-3 of S's trace is
// added to all three).
#include <array>

#include "core/parallel.h"
#include "scene/raster/splat_math.h"
#include "segment/graphcut/neighbour_weights.h"
#include "segment/graphcut/overlap_weights.h"
#include "segment/graphcut/squared_distance.h"

namespace splatcut {

namespace {

Symmetric3 covariance_of(const GaussianCloud& cloud, std::size_t g) {
  const glm::mat3 sigma = covariance_world(cloud.scale[g], cloud.rotation[g]);
  return {sigma[0][0], sigma[0][1], sigma[0][2], sigma[1][1], sigma[1][2], sigma[2][2]};
}

// Of the edges of the nodes from..to, a block at a time.
void overlap_capacities(const GaussianCloud& cloud, const FlowGraph& graph, const NeighbourOptions& options,
                        std::span<const Symmetric3> sigma, std::size_t from, std::size_t to,
                        std::span<std::int32_t> capacity) {
  OverlapBlock block{};
  std::array<std::uint32_t, OverlapBlock::kPairs> arc_of{};
  int pairs = 0;
  const auto flush = [&] {
    overlap_weights(block, options.gamma_position);
    for (int i = 0; i < pairs; ++i) {
      const std::uint32_t arc = arc_of[static_cast<std::size_t>(i)];
      capacity[arc] = capacity[graph.reverse_arc[arc]] = capacity_of(block.psi[i], options.lambda);
    }
    pairs = 0;
  };
  for_edges(graph, from, to, [&](const Edge& edge) {
    arc_of[static_cast<std::size_t>(pairs)] = edge.arc;
    block.set(pairs, sigma[edge.g], sigma[edge.h], cloud.position[edge.g] - cloud.position[edge.h],
              options.gamma_colour * squared_distance(cloud.f_dc[edge.g], cloud.f_dc[edge.h]));
    if (++pairs == OverlapBlock::kPairs) flush();
  });
  flush();
}

void overlap_capacities(const GaussianCloud& cloud, const FlowGraph& graph, const NeighbourOptions& options,
                        std::span<std::int32_t> capacity) {
  std::vector<Symmetric3> sigma(cloud.size());
  for_each_index(cloud.size(), [&](std::size_t g) { sigma[g] = covariance_of(cloud, g); });
  for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
    overlap_capacities(cloud, graph, options, sigma, from, to, capacity);
  });
}

}  // namespace

constinit const Pairwise Pairwise::kOverlap = {.name = "overlap", .capacities = overlap_capacities};

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h) {
  OverlapBlock block{};
  block.set(0, covariance_of(cloud, g), covariance_of(cloud, h), cloud.position[g] - cloud.position[h], 0);
  overlap_weights(block, 1);
  return block.distance[0];
}

}  // namespace splatcut
