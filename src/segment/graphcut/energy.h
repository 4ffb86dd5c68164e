// The energy that the cut minimises: E(y) = sum_g phi_g(y_g) + lambda sum_{g,h} psi(g,h) [y_g != y_h].
//
// psi by `pairwise`, beta = f_dc:
//   kOverlap    exp(-gamma_position D - gamma_colour |dbeta|^2), ours, where
//               D = 1/4 d^T S^-1 d + ln(det S / sqrt(det Sigma_g det Sigma_h)),  S = (Sigma_g + Sigma_h) / 2,
//               twice the Bhattacharyya distance of the two Gaussians, which needs no scene scale (1e-3 of
//               S's trace is added to all three)
//   kPaper      exp(-gamma_position |dmu|^2) + lambda_n exp(-gamma_colour |dbeta|^2)
//   kPaperCode  exp(-gamma_position |dmu|) + lambda_n exp(-gamma_colour |dbeta|), twice that between
//   Gaussians
//               that are both among the other's k nearest
// Source capacity v_g w_g + lambda_u psi_u(g, object clusters), sink capacity v_g (1 - w_g) + lambda_u
// psi_u(g, rest clusters), with the visibility v_g = min(1, A_g / v0), or 1 without it; what was never seen
// has unseen_rest as its sink capacity. psi_u is kPaper's psi (kPaperCode's there) of the likest cluster with
// the gammas of clusters; clusters by k-means over confident Gaussians, in kPaperCode over positions alone
// with one mean colour per side. Source: Jain et al., GaussianCut, NeurIPS 2024, eq. 3-5, and their published
// code; Bhattacharyya 1943. Capacities are integers of 2^-20.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/likelihood.h"
#include "segment/graphcut/max_flow.h"

namespace splatcut {

enum class Pairwise { kOverlap, kPaper, kPaperCode };

struct EnergyOptions {
  Pairwise pairwise = Pairwise::kOverlap;
  float gamma_position = 0.1f;  // 0 leaves the term out, as with all gammas
  float gamma_colour = 1;
  float lambda = 2;  // [0, 500]; smoother than 1: better on photographs and straddling splats (docs/study.md)
  bool visibility = true;
  float v0_px_per_view_at_400 = 3;  // for a 400 x 300 picture; scales with its pixels and the number of views
  float lambda_n = 1;               // paper: weight of colour in psi
  float lambda_u = 0;               // weight of the cluster term; 0 leaves it out
  float gamma_cluster_position = 1, gamma_cluster_colour = 1;
  int object_clusters = 1, rest_clusters = 4;
  float unseen_rest = 0;  // sink capacity of what no view has seen
  bool operator==(const EnergyOptions&) const = default;
};

// GaussianCut's literal weights, and those of its authors' published code.
EnergyOptions paper_energy();
EnergyOptions paper_code_energy();

inline constexpr double kCapacityScale = 1 << 20;

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h);  // D

// lambda psi per arc; both arcs of an edge the same.
std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph,
                                         const EnergyOptions& options);

// True where arc_capacities() gives the same for both.
bool same_neighbour_term(const EnergyOptions& a, const EnergyOptions& b);

struct Terminals {
  std::vector<std::int64_t> net;  // source minus sink
  std::int64_t base_flow = 0;     // sum of min(source, sink)
};

// views and pixels_per_view: what the likelihood was summed over.
Terminals terminals(const GaussianCloud& cloud, const Likelihood& likelihood, int views,
                    double pixels_per_view, const EnergyOptions& options);

}  // namespace splatcut
