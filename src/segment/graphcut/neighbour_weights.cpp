// The neighbour term of the energy: lambda psi per arc.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "scene/raster/splat_math.h"
#include "segment/graphcut/energy.h"
#include "segment/graphcut/overlap_weights.h"
#include "segment/graphcut/squared_distance.h"

namespace splatcut {

namespace {

Symmetric3 covariance_of(const GaussianCloud& cloud, std::size_t g) {
  const glm::mat3 sigma = covariance_world(cloud.scale[g], cloud.rotation[g]);
  return {sigma[0][0], sigma[0][1], sigma[0][2], sigma[1][1], sigma[1][2], sigma[2][2]};
}

// lambda psi as an integer capacity.
std::int32_t capacity_of(float psi, float lambda) {
  constexpr double kLargest = (1 << 30) - 1;  // of the maximum flow
  const double capacity =
      static_cast<double>(lambda) * static_cast<double>(std::isfinite(psi) ? psi : 0.0f) * kCapacityScale;
  return static_cast<std::int32_t>(std::llround(std::min(capacity, kLargest)));
}

// Calls work(arc, g, h) for the arcs of the nodes from..to that lead to a later node: each edge once.
template <class Work>
void for_edges(const FlowGraph& graph, std::size_t from, std::size_t to, const Work& work) {
  for (std::size_t g = from; g < to; ++g)
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc)
      if (graph.head[arc] > g) work(arc, g, graph.head[arc]);
}

void overlap_capacities(const GaussianCloud& cloud, const EnergyOptions& options, const FlowGraph& graph,
                        std::span<const Symmetric3> sigma, std::size_t from, std::size_t to,
                        std::vector<std::int32_t>& capacity) {
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
  for_edges(graph, from, to, [&](std::uint32_t arc, std::size_t g, std::size_t h) {
    arc_of[static_cast<std::size_t>(pairs)] = arc;
    block.set(pairs, sigma[g], sigma[h], cloud.position[g] - cloud.position[h],
              options.gamma_colour * squared_distance(cloud.f_dc[g], cloud.f_dc[h]));
    if (++pairs == OverlapBlock::kPairs) flush();
  });
  flush();
}

// Both are among the other's k nearest, not one of them only.
bool mutual(const FlowGraph& graph, std::uint32_t arc, std::size_t g, std::size_t h) {
  return arc - graph.first_arc[g] < graph.listed &&
         graph.reverse_arc[arc] - graph.first_arc[h] < graph.listed;
}

}  // namespace

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h) {
  OverlapBlock block{};
  block.set(0, covariance_of(cloud, g), covariance_of(cloud, h), cloud.position[g] - cloud.position[h], 0);
  overlap_weights(block, 1);
  return block.distance[0];
}

bool same_neighbour_term(const EnergyOptions& a, const EnergyOptions& b) {
  return a.pairwise == b.pairwise && a.gamma_position == b.gamma_position &&
         a.gamma_colour == b.gamma_colour && a.lambda == b.lambda && a.lambda_n == b.lambda_n;
}

std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph,
                                         const EnergyOptions& options) {
  std::vector<std::int32_t> capacity(graph.arcs());
  if (options.pairwise == Pairwise::kOverlap) {
    std::vector<Symmetric3> sigma(cloud.size());
    for_each_index(cloud.size(), [&](std::size_t g) { sigma[g] = covariance_of(cloud, g); });
    for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
      overlap_capacities(cloud, options, graph, sigma, from, to, capacity);
    });
    return capacity;
  }
  const auto psi = [&](std::uint32_t arc, std::size_t g, std::size_t h) {
    const float d2 = squared_distance(cloud.position[g], cloud.position[h]),
                c2 = squared_distance(cloud.f_dc[g], cloud.f_dc[h]);
    const bool squared = options.pairwise == Pairwise::kPaper;
    const float times = !squared && mutual(graph, arc, g, h) ? 2.0f : 1.0f;
    return times * (std::exp(-options.gamma_position * (squared ? d2 : std::sqrt(d2))) +
                    options.lambda_n * std::exp(-options.gamma_colour * (squared ? c2 : std::sqrt(c2))));
  };
  for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
    for_edges(graph, from, to, [&](std::uint32_t arc, std::size_t g, std::size_t h) {
      capacity[arc] = capacity[graph.reverse_arc[arc]] = capacity_of(psi(arc, g, h), options.lambda);
    });
  });
  return capacity;
}

}  // namespace splatcut
