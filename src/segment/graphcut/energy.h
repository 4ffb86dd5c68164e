// The energy that the cut minimises: E(y) = sum_g phi_g(y_g) + lambda sum_{g,h} psi(g,h) [y_g != y_h].
//
// psi is a row of SPLATCUT_PAIRWISE (the n-links of the graph), phi the sum of SPLATCUT_DATA_TERMS (the
// t-links): source capacity for the object, sink capacity for the background, called rest. Formulas are in
// terms/, beta = f_dc there.
// Source: Jain et al., GaussianCut, NeurIPS 2024, eq. 3-5, and their published code; Bhattacharyya 1943.
// Capacities are integers of 2^-20.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/likelihood.h"
#include "segment/graphcut/max_flow.h"

// A pairwise energy, a data term: one file in src/segment/graphcut/terms that defines it, and one line here.
// In the order of lists and of the sum.
// clang-format off
#define SPLATCUT_PAIRWISE(row) \
  row(kOverlap)                \
  row(kPaper)                  \
  row(kPaperCode)

#define SPLATCUT_DATA_TERMS(term) \
  term(views_term)                \
  term(cluster_term)
// clang-format on

namespace splatcut {

struct NeighbourOptions;

struct Edge {
  std::uint32_t arc;  // from g to h
  std::size_t g, h;
};

// One row. A value that is copied freely; rows are equal where their names are.
struct Pairwise {
  const char* name = "";  // in settings and reports: "paper-code"

  // Of one edge. What it depends on beside cloud and graph is in NeighbourOptions, by which the solver knows
  // whether arcs are still right.
  float (*psi)(const GaussianCloud& cloud, const FlowGraph& graph, const Edge& edge,
               const NeighbourOptions& options) = nullptr;

  // In its place where many edges at a time are faster: lambda psi of every arc, see neighbour_weights.h.
  void (*capacities)(const GaussianCloud& cloud, const FlowGraph& graph, const NeighbourOptions& options,
                     std::span<std::int32_t> capacity) = nullptr;

  bool plain_distances = false;  // |d| in its exponents, not |d|^2; those of the cluster term follow

  friend bool operator==(const Pairwise& a, const Pairwise& b) { return std::string_view(a.name) == b.name; }

#define SPLATCUT_DECLARE_ROW(row) static const Pairwise row;
  SPLATCUT_PAIRWISE(SPLATCUT_DECLARE_ROW)
#undef SPLATCUT_DECLARE_ROW
};

std::vector<Pairwise> pairwise_energies();

// All that the arcs depend on.
struct NeighbourOptions {
  Pairwise pairwise = Pairwise::kOverlap;
  float gamma_position = 0.1f;  // 0 leaves the term out, as with all gammas
  float gamma_colour = 1;
  float lambda = 2;  // [0, 500]; smoother than 1: better on photographs and straddling splats (docs/masks.md)
  float lambda_n = 1;  // paper: weight of colour in psi
  bool operator==(const NeighbourOptions&) const = default;
};

struct EnergyOptions : NeighbourOptions {
  bool visibility = true;
  float v0_px_per_view_at_400 = 3;  // for a 400 x 300 picture; scales with its pixels and the number of views
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

float overlap_distance(const GaussianCloud& cloud, std::size_t g, std::size_t h);  // kOverlap's D

// lambda psi per arc; both arcs of an edge the same.
std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph,
                                         const NeighbourOptions& options);

// What the data terms see. views and pixels_per_view: what the likelihood was summed over.
struct DataInput {
  const GaussianCloud& cloud;
  const Likelihood& likelihood;
  int views;
  double pixels_per_view;
  const EnergyOptions& options;
};
struct DataCapacities {
  double source = 0, sink = 0;
};
using DataTerm = std::function<DataCapacities(std::size_t g)>;  // called from many threads at once

// The term for an input, which outlives it; none where the options leave it out.
#define SPLATCUT_DECLARE_TERM(term) DataTerm term(const DataInput& input);
SPLATCUT_DATA_TERMS(SPLATCUT_DECLARE_TERM)
#undef SPLATCUT_DECLARE_TERM

struct Terminals {
  std::vector<std::int64_t> net;  // source minus sink
  std::int64_t base_flow = 0;     // sum of min(source, sink)
};

Terminals terminals(const GaussianCloud& cloud, const Likelihood& likelihood, int views,
                    double pixels_per_view, const EnergyOptions& options);

}  // namespace splatcut
