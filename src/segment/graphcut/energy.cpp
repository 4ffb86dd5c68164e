// The data term of the energy, and the presets.
#include "segment/graphcut/energy.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "segment/graphcut/squared_distance.h"

namespace splatcut {

namespace {

struct Cluster {
  glm::vec3 position, colour;
};

// k-means of the Gaussians named, over position and, unless left out, colour; starts spread over their
// (Morton) order.
std::vector<Cluster> clusters_of(const GaussianCloud& cloud, const std::vector<std::uint32_t>& members, int k,
                                 bool over_colour) {
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
        const float d = squared_distance(cloud.position[g], clusters[c].position) +
                        (over_colour ? squared_distance(cloud.f_dc[g], clusters[c].colour) : 0.0f);
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

void share_mean_colour(const GaussianCloud& cloud, const std::vector<std::uint32_t>& members,
                       std::vector<Cluster>* clusters) {
  glm::dvec3 sum(0);
  for (const std::uint32_t g : members) sum += glm::dvec3(cloud.f_dc[g]);
  for (Cluster& c : *clusters) c.colour = glm::vec3(sum / static_cast<double>(members.size()));
}

// The cluster term: clusters of the confident Gaussians of both sides.
class ClusterTerm {
 public:
  ClusterTerm(const GaussianCloud& cloud, const Likelihood& likelihood, const EnergyOptions& options)
      : cloud_(cloud), options_(options), squared_(options.pairwise != Pairwise::kPaperCode) {
    if (options.lambda_u == 0) return;
    std::vector<std::uint32_t> object, rest;
    constexpr float kConfident = 0.9f;
    for (std::uint32_t g = 0; g < cloud.size(); ++g) {
      if (likelihood.w[g] >= kConfident) object.push_back(g);
      if (likelihood.seen_px[g] > 0 && likelihood.w[g] <= 1 - kConfident) rest.push_back(g);
    }
    object_ = clusters_of(cloud, object, options.object_clusters, squared_);
    rest_ = clusters_of(cloud, rest, options.rest_clusters, squared_);
    if (squared_) return;
    share_mean_colour(cloud, object, &object_);
    share_mean_colour(cloud, rest, &rest_);
  }
  double object(std::size_t g) const { return likest(g, object_); }
  double rest(std::size_t g) const { return likest(g, rest_); }

 private:
  double likest(std::size_t g, const std::vector<Cluster>& clusters) const {
    float best = 0;
    for (const Cluster& c : clusters) {
      const float d2 = squared_distance(cloud_.position[g], c.position),
                  c2 = squared_distance(cloud_.f_dc[g], c.colour);
      best = std::max(best, std::exp(-options_.gamma_cluster_position * (squared_ ? d2 : std::sqrt(d2))) +
                                options_.lambda_n * std::exp(-options_.gamma_cluster_colour *
                                                             (squared_ ? c2 : std::sqrt(c2))));
    }
    return static_cast<double>(options_.lambda_u * best);
  }

  const GaussianCloud& cloud_;
  const EnergyOptions& options_;
  bool squared_;
  std::vector<Cluster> object_, rest_;
};

}  // namespace

EnergyOptions paper_energy() {
  EnergyOptions options;
  options.pairwise = Pairwise::kPaper;
  options.lambda = 0.5f;
  options.visibility = false;
  options.lambda_u = 1;
  options.unseen_rest = 1;  // its w_g is 0
  return options;
}

EnergyOptions paper_code_energy() {
  EnergyOptions options = paper_energy();
  options.pairwise = Pairwise::kPaperCode;
  options.gamma_position = 1;
  options.lambda_u = 0.5f;  // position and colour count half each, as between neighbours
  options.gamma_cluster_position = 0.1f;
  options.object_clusters = options.rest_clusters = 5;
  options.unseen_rest = 0.01f;
  return options;
}

Terminals terminals(const GaussianCloud& cloud, const Likelihood& likelihood, int views,
                    double pixels_per_view, const EnergyOptions& options) {
  const ClusterTerm clusters(cloud, likelihood, options);
  constexpr double kPixelsAt400 = 400.0 * 300.0;
  const double v0 = static_cast<double>(options.v0_px_per_view_at_400) *
                    static_cast<double>(std::max(1, views)) * pixels_per_view / kPixelsAt400;
  Terminals out;
  out.net.resize(cloud.size());
  std::atomic<std::int64_t> base_flow = 0;  // an integer: the order of the sum does not matter
  const auto net_of = [&](std::size_t g) {
    const bool seen = likelihood.seen_px[g] > 0;
    const double v = !seen                          ? 0.0
                     : options.visibility && v0 > 0 ? std::min(1.0, likelihood.seen_px[g] / v0)
                                                    : 1.0;
    double source = v * likelihood.w[g], sink = v * (1.0 - likelihood.w[g]);
    if (!seen) sink = static_cast<double>(options.unseen_rest);
    if (options.lambda_u > 0) {
      source += clusters.object(g);
      sink += clusters.rest(g);
    }
    constexpr std::int64_t kLargest = MaxFlow::kLargestTerminal;
    const std::int64_t s = std::min<std::int64_t>(std::llround(source * kCapacityScale), kLargest),
                       t = std::min<std::int64_t>(std::llround(sink * kCapacityScale), kLargest);
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
