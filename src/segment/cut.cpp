#include "segment/cut.h"

namespace splatcut {

CutReport cut_object(const GaussianCloud& cloud, const FlowGraph& graph, std::span<const std::int32_t> capacity,
                     const Likelihood& likelihood, int views, double pixels_per_view, const CutOptions& options,
                     const Job& job) {
  CutReport report;
  if (options.coarse) {
    report.labels.resize(cloud.size());
    for (std::size_t g = 0; g < cloud.size(); ++g) report.labels[g] = likelihood.w[g] > options.tau;
    return report;
  }
  std::vector<std::int32_t> computed;
  if (capacity.empty()) capacity = computed = arc_capacities(cloud, graph, options.energy);
  const Terminals data = terminals(cloud, likelihood, views, pixels_per_view, options.energy);
  MinCutReport cut = min_cut(graph, capacity, data.net, data.base_flow, job);
  report.labels = std::move(cut.source_side);
  report.nodes = graph.nodes();
  report.arcs = graph.arcs();
  report.energy = static_cast<double>(cut.energy) / kCapacityScale;
  report.flow = static_cast<double>(cut.flow) / kCapacityScale;
  return report;
}

}  // namespace splatcut
