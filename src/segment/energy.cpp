#include "segment/energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "scene/splat_math.h"
#include "segment/overlap_weights.h"

namespace splatcut {

namespace {

constexpr std::size_t kChunk = 8192;

template <class Work>
void for_chunks(std::size_t n, const Work& work) {
  tbb::parallel_for(std::size_t{0}, (n + kChunk - 1) / kChunk,
                    [&](std::size_t c) { work(c * kChunk, std::min(n, (c + 1) * kChunk)); });
}

float distance2(const glm::vec3& a, const glm::vec3& b) { return glm::dot(a - b, a - b); }

struct Cluster {
  glm::vec3 position, colour;
};

// k-means over position and colour of the Gaussians named; starts spread over their (Morton) order.
std::vector<Cluster> clusters_of(const GaussianCloud& cloud, const std::vector<std::uint32_t>& members, int k) {
  std::vector<Cluster> clusters;
  const std::size_t count = std::min<std::size_t>(static_cast<std::size_t>(k), members.size());
  for (std::size_t c = 0; c < count; ++c) {
    const std::uint32_t g = members[(2 * c + 1) * members.size() / (2 * count)];
    clusters.push_back({cloud.position[g], cloud.f_dc[g]});
  }
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds && !clusters.empty(); ++round) {
    std::vector<glm::dvec3> position(count, glm::dvec3(0)), colour(count, glm::dvec3(0));
    std::vector<double> weight(count, 0);
    for (const std::uint32_t g : members) {
      std::size_t best = 0;
      float least = std::numeric_limits<float>::max();
      for (std::size_t c = 0; c < count; ++c) {
        const float d = distance2(cloud.position[g], clusters[c].position) + distance2(cloud.f_dc[g], clusters[c].colour);
        if (d < least) {
          least = d;
          best = c;
        }
      }
      position[best] += glm::dvec3(cloud.position[g]);
      colour[best] += glm::dvec3(cloud.f_dc[g]);
      weight[best] += 1;
    }
    for (std::size_t c = 0; c < count; ++c)
      if (weight[c] > 0) clusters[c] = {glm::vec3(position[c] / weight[c]), glm::vec3(colour[c] / weight[c])};
  }
  return clusters;
}

float cluster_similarity(const GaussianCloud& cloud, std::size_t g, const std::vector<Cluster>& clusters, const EnergyOptions& options) {
  float best = 0;
  for (const Cluster& c : clusters)
    best = std::max(best, std::exp(-options.gamma_cluster * distance2(cloud.position[g], c.position)) +
                              options.lambda_n * std::exp(-options.gamma_cluster * distance2(cloud.f_dc[g], c.colour)));
  return best;
}

}  // namespace

EnergyOptions paper_energy() {
  EnergyOptions options;
  options.pairwise = Pairwise::kPaper;
  options.lambda = 0.5f;
  options.visibility = false;
  options.lambda_u = 1;
  return options;
}

namespace {

Symmetric3 covariance_of(const GaussianCloud& cloud, std::size_t g) {
  const glm::mat3 sigma = covariance_world(cloud.scale[g], cloud.rotation[g]);
  return {sigma[0][0], sigma[0][1], sigma[0][2], sigma[1][1], sigma[1][2], sigma[2][2]};
}

// lambda psi as an integer capacity.
std::int32_t capacity_of(float psi, float lambda) {
  return static_cast<std::int32_t>(std::llround(static_cast<double>(lambda) * static_cast<double>(std::isfinite(psi) ? psi : 0.0f) * kCapacityScale));
}

// Calls work(arc, g, h) for the arcs of the nodes from..to that lead to a later node: each edge once.
template <class Work>
void for_edges(const FlowGraph& graph, std::size_t from, std::size_t to, const Work& work) {
  for (std::size_t g = from; g < to; ++g)
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc)
      if (graph.head[arc] > g) work(arc, g, graph.head[arc]);
}

void overlap_capacities(const GaussianCloud& cloud, const FlowGraph& graph, const EnergyOptions& options,
                        std::span<const Symmetric3> sigma, std::size_t from, std::size_t to, std::vector<std::int32_t>& capacity) {
  OverlapBlock block{};
  std::array<std::uint32_t, OverlapBlock::kPairs> arc_of{};
  int pairs = 0;
  const auto flush = [&] {
    overlap_weights(block, options.gamma_position, options.gamma_colour);
    for (int i = 0; i < pairs; ++i) {
      const std::uint32_t arc = arc_of[static_cast<std::size_t>(i)];
      capacity[arc] = capacity[graph.reverse_arc[arc]] = capacity_of(block.psi[i], options.lambda);
    }
    pairs = 0;
  };
  for_edges(graph, from, to, [&](std::uint32_t arc, std::size_t g, std::size_t h) {
    arc_of[static_cast<std::size_t>(pairs)] = arc;
    block.set(pairs, sigma[g], sigma[h], cloud.position[g] - cloud.position[h], distance2(cloud.f_dc[g], cloud.f_dc[h]));
    if (++pairs == OverlapBlock::kPairs) flush();
  });
  flush();
}

}  // namespace

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h) {
  OverlapBlock block{};
  block.set(0, covariance_of(cloud, g), covariance_of(cloud, h), cloud.position[g] - cloud.position[h], 0);
  overlap_weights(block, 1, 1);
  return block.distance[0];
}

std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph, const EnergyOptions& options) {
  std::vector<std::int32_t> capacity(graph.arcs());
  if (options.pairwise == Pairwise::kOverlap) {
    std::vector<Symmetric3> sigma(cloud.size());
    for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
      for (std::size_t g = from; g < to; ++g) sigma[g] = covariance_of(cloud, g);
    });
    for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
      overlap_capacities(cloud, graph, options, sigma, from, to, capacity);
    });
    return capacity;
  }
  for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
    for_edges(graph, from, to, [&](std::uint32_t arc, std::size_t g, std::size_t h) {
      const float psi = std::exp(-options.gamma_position * distance2(cloud.position[g], cloud.position[h])) +
                        options.lambda_n * std::exp(-options.gamma_colour * distance2(cloud.f_dc[g], cloud.f_dc[h]));
      capacity[arc] = capacity[graph.reverse_arc[arc]] = capacity_of(psi, options.lambda);
    });
  });
  return capacity;
}

Terminals terminals(const GaussianCloud& cloud, const Likelihood& likelihood, int views, double pixels_per_view,
                    const EnergyOptions& options) {
  std::vector<Cluster> object_clusters, rest_clusters;
  if (options.lambda_u > 0) {
    std::vector<std::uint32_t> object, rest;
    constexpr float kConfident = 0.9f;
    for (std::uint32_t g = 0; g < cloud.size(); ++g) {
      if (likelihood.w[g] >= kConfident) object.push_back(g);
      if (likelihood.seen_px[g] > 0 && likelihood.w[g] <= 1 - kConfident) rest.push_back(g);
    }
    object_clusters = clusters_of(cloud, object, options.object_clusters);
    rest_clusters = clusters_of(cloud, rest, options.rest_clusters);
  }
  constexpr double kPixelsAt400 = 400.0 * 300.0;
  const double v0 = static_cast<double>(options.v0_px_per_view_at_400) * static_cast<double>(std::max(1, views)) * pixels_per_view / kPixelsAt400;
  Terminals out;
  out.net.resize(cloud.size());
  std::atomic<std::int64_t> base_flow = 0;  // an integer: the order of the sum does not matter
  const auto net_of = [&](std::size_t g) {
    const double v = options.visibility ? std::min(1.0, likelihood.seen_px[g] / v0) : 1.0;
    double source = v * likelihood.w[g], sink = v * (1.0 - likelihood.w[g]);
    if (options.lambda_u > 0) {
      source += options.lambda_u * cluster_similarity(cloud, g, object_clusters, options);
      sink += options.lambda_u * cluster_similarity(cloud, g, rest_clusters, options);
    }
    const auto s = std::llround(source * kCapacityScale), t = std::llround(sink * kCapacityScale);
    out.net[g] = s - t;
    return std::min(s, t);
  };
  for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
    std::int64_t sum = 0;
    for (std::size_t g = from; g < to; ++g) sum += net_of(g);
    base_flow += sum;
  });
  out.base_flow = base_flow;
  return out;
}

}  // namespace splatcut
