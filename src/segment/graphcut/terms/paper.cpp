// GaussianCut's neighbour terms and the weights that go with them.
//
// kPaper      psi = exp(-gamma_position |dmu|^2) + lambda_n exp(-gamma_colour |dbeta|^2)
// kPaperCode  psi = exp(-gamma_position |dmu|) + lambda_n exp(-gamma_colour |dbeta|), twice that between
//             Gaussians that are both among the other's k nearest
#include <cmath>

#include "segment/graphcut/energy.h"
#include "segment/graphcut/squared_distance.h"

namespace splatcut {

namespace {

// Both are among the other's k nearest, not one of them only.
bool mutual(const FlowGraph& graph, const Edge& edge) {
  return edge.arc - graph.first_arc[edge.g] < graph.listed &&
         graph.reverse_arc[edge.arc] - graph.first_arc[edge.h] < graph.listed;
}

float paper_psi(const GaussianCloud& cloud, const FlowGraph& graph, const Edge& edge,
                const NeighbourOptions& options) {
  const float d2 = squared_distance(cloud.position[edge.g], cloud.position[edge.h]),
              c2 = squared_distance(cloud.f_dc[edge.g], cloud.f_dc[edge.h]);
  const bool squared = !options.pairwise.plain_distances;
  const float times = !squared && mutual(graph, edge) ? 2.0f : 1.0f;
  return times * (std::exp(-options.gamma_position * (squared ? d2 : std::sqrt(d2))) +
                  options.lambda_n * std::exp(-options.gamma_colour * (squared ? c2 : std::sqrt(c2))));
}

}  // namespace

constinit const Pairwise Pairwise::kPaper = {.name = "paper", .psi = paper_psi};
constinit const Pairwise Pairwise::kPaperCode = {
    .name = "paper-code", .psi = paper_psi, .plain_distances = true};

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

}  // namespace splatcut
