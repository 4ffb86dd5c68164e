// The energy that the cut minimises: E(y) = sum_g phi_g(y_g) + lambda sum_{g,h} psi(g,h) [y_g != y_h].
//
// Ours (kOverlap): psi = exp(-gamma_position D - gamma_colour |dbeta|^2), with
//   D = 1/4 d^T S^-1 d + ln(det S / sqrt(det Sigma_g det Sigma_h)),  S = (Sigma_g + Sigma_h) / 2,
// twice the Bhattacharyya distance of the two Gaussians, which needs no scene scale (1e-3 of S's trace is
// added to all three); beta = f_dc. Source and sink capacity v_g w_g and v_g (1 - w_g), with the visibility
// v_g = min(1, A_g / v0). Never seen: no data term.
// The paper's (kPaper): psi = exp(-gamma_position |dmu|^2) + lambda_n exp(-gamma_colour |dbeta|^2); capacities
// w_g + lambda_u psi(g, nearest object cluster) and 1 - w_g + lambda_u psi(g, nearest rest cluster), clusters
// by k-means over confident Gaussians, 1 object and 4 rest.
// Source: Jain et al., GaussianCut, NeurIPS 2024, eq. 3-5; Bhattacharyya 1943.
// Capacities are integers of 2^-20.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/gaussian_cloud.h"
#include "segment/likelihood.h"
#include "segment/max_flow.h"

namespace splatcut {

enum class Pairwise { kOverlap, kPaper };

struct EnergyOptions {
  Pairwise pairwise = Pairwise::kOverlap;
  float gamma_position = 0.1f;
  float gamma_colour = 1;
  float lambda = 1;                    // [0, 500]
  bool visibility = true;
  float v0_px_per_view_at_400 = 0.8f;  // for a 400 x 300 picture; scales with its pixels and the number of views
  float lambda_n = 1;                  // paper: weight of colour in psi
  float lambda_u = 0;                  // weight of the cluster term; 0 leaves it out
  float gamma_cluster = 1;
  int object_clusters = 1, rest_clusters = 4;
};

// GaussianCut's literal weights.
EnergyOptions paper_energy();

inline constexpr double kCapacityScale = 1 << 20;

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h);  // D

// lambda psi per arc; both arcs of an edge the same.
std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph, const EnergyOptions& options);

struct Terminals {
  std::vector<std::int64_t> net;  // source minus sink
  std::int64_t base_flow = 0;     // sum of min(source, sink)
};

// views and pixels_per_view: what the likelihood was summed over.
Terminals terminals(const GaussianCloud& cloud, const Likelihood& likelihood, int views, double pixels_per_view,
                    const EnergyOptions& options);

}  // namespace splatcut
