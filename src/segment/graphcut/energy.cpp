// The tables of the energy, and what the cut makes of their rows.
#include "segment/graphcut/energy.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "segment/graphcut/neighbour_weights.h"

namespace splatcut {

std::vector<Pairwise> pairwise_energies() {
  return {
#define SPLATCUT_LIST_ROW(row) Pairwise::row,
      SPLATCUT_PAIRWISE(SPLATCUT_LIST_ROW)
#undef SPLATCUT_LIST_ROW
  };
}

std::vector<std::int32_t> arc_capacities(const GaussianCloud& cloud, const FlowGraph& graph,
                                         const NeighbourOptions& options) {
  std::vector<std::int32_t> capacity(graph.arcs());
  const Pairwise& pairwise = options.pairwise;
  if (pairwise.capacities) {
    pairwise.capacities(cloud, graph, options, capacity);
    return capacity;
  }
  for_chunks(cloud.size(), [&](std::size_t from, std::size_t to) {
    for_edges(graph, from, to, [&](const Edge& edge) {
      capacity[edge.arc] = capacity[graph.reverse_arc[edge.arc]] =
          capacity_of(pairwise.psi(cloud, graph, edge, options), options.lambda);
    });
  });
  return capacity;
}

Terminals terminals(const GaussianCloud& cloud, const Likelihood& likelihood, int views,
                    double pixels_per_view, const EnergyOptions& options) {
  const DataInput input{cloud, likelihood, views, pixels_per_view, options};
  std::vector<DataTerm> terms;
#define SPLATCUT_ADD_TERM(term) terms.push_back(term(input));
  SPLATCUT_DATA_TERMS(SPLATCUT_ADD_TERM)
#undef SPLATCUT_ADD_TERM
  std::erase_if(terms, [](const DataTerm& term) { return !term; });
  Terminals out;
  out.net.resize(cloud.size());
  std::atomic<std::int64_t> base_flow = 0;  // an integer: the order of the sum does not matter
  const auto net_of = [&](std::size_t g) {
    double source = 0, sink = 0;
    for (const DataTerm& term : terms) {
      const DataCapacities of_term = term(g);
      source += of_term.source;
      sink += of_term.sink;
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
