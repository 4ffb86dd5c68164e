// The cluster term: source lambda_u psi_u(g, object clusters), sink lambda_u psi_u(g, rest clusters).
//
// psi_u is kPaper's psi (kPaperCode's there) of the likest cluster with the gammas of clusters; clusters by
// k-means over confident Gaussians of both sides, in kPaperCode over positions alone with one mean colour per
// side.
#include <algorithm>
#include <cmath>
#include <limits>

#include "segment/graphcut/energy.h"
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

class ClusterTerm {
 public:
  explicit ClusterTerm(const DataInput& input)
      : cloud_(input.cloud), options_(input.options), squared_(!input.options.pairwise.plain_distances) {
    std::vector<std::uint32_t> object, rest;
    constexpr float kConfident = 0.9f;
    for (std::uint32_t g = 0; g < cloud_.size(); ++g) {
      if (input.likelihood.w[g] >= kConfident) object.push_back(g);
      if (input.likelihood.seen_px[g] > 0 && input.likelihood.w[g] <= 1 - kConfident) rest.push_back(g);
    }
    object_ = clusters_of(cloud_, object, options_.object_clusters, squared_);
    rest_ = clusters_of(cloud_, rest, options_.rest_clusters, squared_);
    if (squared_) return;
    share_mean_colour(cloud_, object, &object_);
    share_mean_colour(cloud_, rest, &rest_);
  }
  DataCapacities operator()(std::size_t g) const { return {likest(g, object_), likest(g, rest_)}; }

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

DataTerm cluster_term(const DataInput& input) {
  if (!(input.options.lambda_u > 0)) return {};
  return ClusterTerm(input);
}

}  // namespace splatcut
