// The neighbour term of the energy: lambda psi per arc.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "scene/splat_math.h"
#include "segment/energy.h"
#include "segment/overlap_weights.h"
#include "segment/parallel.h"
#include "segment/squared_distance.h"

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

// What the colours and the shortest axes say against an edge: the exponent is linear in both.
struct Unlikeness {
  const GaussianCloud& cloud;
  const EnergyOptions& options;
  std::vector<glm::vec3> axis;  // empty without the concavity term

  Unlikeness(const GaussianCloud& of, const EnergyOptions& with) : cloud(of), options(with) {
    if (options.concavity == 0) return;
    axis.resize(cloud.size());
    for_each_index(cloud.size(),
                   [&](std::size_t g) { axis[g] = shortest_axis(cloud.scale[g], cloud.rotation[g]); });
  }
  float turn(std::size_t g, std::size_t h) const {
    return axis.empty() ? 0.0f
                        : options.concavity * (1 - std::min(1.0f, std::abs(glm::dot(axis[g], axis[h]))));
  }
  float operator()(std::size_t g, std::size_t h) const {
    return options.gamma_colour * squared_distance(cloud.f_dc[g], cloud.f_dc[h]) + turn(g, h);
  }
};

void overlap_capacities(const Unlikeness& unlike, const FlowGraph& graph, std::span<const Symmetric3> sigma,
                        std::size_t from, std::size_t to, std::vector<std::int32_t>& capacity) {
  OverlapBlock block{};
  std::array<std::uint32_t, OverlapBlock::kPairs> arc_of{};
  int pairs = 0;
  const std::vector<glm::vec3>& position = unlike.cloud.position;
  const auto flush = [&] {
    overlap_weights(block, unlike.options.gamma_position);
    for (int i = 0; i < pairs; ++i) {
      const std::uint32_t arc = arc_of[static_cast<std::size_t>(i)];
      capacity[arc] = capacity[graph.reverse_arc[arc]] = capacity_of(block.psi[i], unlike.options.lambda);
    }
    pairs = 0;
  };
  for_edges(graph, from, to, [&](std::uint32_t arc, std::size_t g, std::size_t h) {
    arc_of[static_cast<std::size_t>(pairs)] = arc;
    block.set(pairs, sigma[g], sigma[h], position[g] - position[h], unlike(g, h));
    if (++pairs == OverlapBlock::kPairs) flush();
  });
  flush();
}

float median_arc_length2(const GaussianCloud& cloud, const FlowGraph& graph) {
  std::vector<float> length2(graph.arcs());
  for_each_index(graph.nodes(), [&](std::size_t g) {
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc)
      length2[arc] = squared_distance(cloud.position[g], cloud.position[graph.head[arc]]);
  });
  if (length2.empty()) return 1;
  const auto middle = length2.begin() + static_cast<std::ptrdiff_t>(length2.size() / 2);
  std::ranges::nth_element(length2, middle);
  return *middle > 0 ? *middle : 1.0f;
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
         a.gamma_colour == b.gamma_colour && a.concavity == b.concavity && a.lambda == b.lambda &&
         a.lambda_n == b.lambda_n;
}

std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph,
                                         const EnergyOptions& options) {
  std::vector<std::int32_t> capacity(graph.arcs());
  const Unlikeness unlike(cloud, options);
  if (options.pairwise == Pairwise::kOverlap) {
    std::vector<Symmetric3> sigma(cloud.size());
    for_each_index(cloud.size(), [&](std::size_t g) { sigma[g] = covariance_of(cloud, g); });
    for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
      overlap_capacities(unlike, graph, sigma, from, to, capacity);
    });
    return capacity;
  }
  const float d0_2 = options.pairwise == Pairwise::kDistance ? median_arc_length2(cloud, graph) : 1.0f;
  const auto psi = [&](std::uint32_t arc, std::size_t g, std::size_t h) {
    const float d2 = squared_distance(cloud.position[g], cloud.position[h]),
                c2 = squared_distance(cloud.f_dc[g], cloud.f_dc[h]);
    if (options.pairwise == Pairwise::kDistance)
      return std::exp(-options.gamma_position * d2 / d0_2 - unlike(g, h));
    const bool squared = options.pairwise == Pairwise::kPaper;
    const float times = (!squared && mutual(graph, arc, g, h) ? 2.0f : 1.0f) * std::exp(-unlike.turn(g, h));
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
