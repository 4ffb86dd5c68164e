#include "segment/energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/splat_math.h"

namespace splatcut {

namespace {

constexpr std::size_t kChunk = 8192;

template <class Work>
void for_chunks(std::size_t n, const Work& work) {
  tbb::parallel_for(std::size_t{0}, (n + kChunk - 1) / kChunk,
                    [&](std::size_t c) { work(c * kChunk, std::min(n, (c + 1) * kChunk)); });
}

float overlap_distance(const glm::mat3& sigma_g, const glm::mat3& sigma_h, const glm::vec3& d) {
  glm::mat3 s = 0.5f * (sigma_g + sigma_h);
  const float ridge = 1e-3f * (s[0][0] + s[1][1] + s[2][2]);
  // Scaled to unit trace: determinants of tiny scenes stay in range, and D does not change.
  const float unit = ridge > 0 ? 1e-3f / ridge : 1.0f;
  const glm::mat3 r(1e-3f);
  s = s * unit + r;
  const glm::mat3 a = sigma_g * unit + r, b = sigma_h * unit + r;
  const glm::vec3 scaled = d * std::sqrt(unit);
  const float mahalanobis2 = glm::dot(scaled, glm::inverse(s) * scaled);
  return 0.25f * mahalanobis2 + std::log(glm::determinant(s) / std::sqrt(glm::determinant(a) * glm::determinant(b)));
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

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h) {
  return overlap_distance(covariance_world(cloud.scale[g], cloud.rotation[g]), covariance_world(cloud.scale[h], cloud.rotation[h]),
                          cloud.position[g] - cloud.position[h]);
}

std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph, const EnergyOptions& options) {
  std::vector<std::int32_t> capacity(graph.arcs());
  std::vector<glm::mat3> sigma;
  if (options.pairwise == Pairwise::kOverlap) {
    sigma.resize(cloud.size());
    for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
      for (std::size_t g = from; g < to; ++g) sigma[g] = covariance_world(cloud.scale[g], cloud.rotation[g]);
    });
  }
  for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t g = from; g < to; ++g)
      for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc) {
        const std::uint32_t h = graph.head[arc];
        if (h < g) continue;  // the other end writes both
        const float colour2 = distance2(cloud.f_dc[g], cloud.f_dc[h]);
        const float psi = options.pairwise == Pairwise::kOverlap
                              ? std::exp(-options.gamma_position * overlap_distance(sigma[g], sigma[h], cloud.position[g] - cloud.position[h]) -
                                         options.gamma_colour * colour2)
                              : std::exp(-options.gamma_position * distance2(cloud.position[g], cloud.position[h])) +
                                    options.lambda_n * std::exp(-options.gamma_colour * colour2);
        const double units = static_cast<double>(options.lambda) * static_cast<double>(std::isfinite(psi) ? psi : 0.0f) * kCapacityScale;
        capacity[arc] = capacity[graph.reverse_arc[arc]] = static_cast<std::int32_t>(std::llround(units));
      }
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
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const double v = options.visibility ? std::min(1.0, likelihood.seen_px[g] / v0) : 1.0;
    double source = v * likelihood.w[g], sink = v * (1.0 - likelihood.w[g]);
    if (options.lambda_u > 0) {
      source += options.lambda_u * cluster_similarity(cloud, g, object_clusters, options);
      sink += options.lambda_u * cluster_similarity(cloud, g, rest_clusters, options);
    }
    const auto s = std::llround(source * kCapacityScale), t = std::llround(sink * kCapacityScale);
    out.net[g] = s - t;
    out.base_flow += std::min(s, t);
  }
  return out;
}

}  // namespace splatcut
