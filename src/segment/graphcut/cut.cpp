#include "segment/graphcut/cut.h"

#include <algorithm>
#include <stdexcept>

namespace splatcut {

namespace {

// More than all arcs of a node and its own weight carry, but where neighbours weigh some hundred times what
// they usually do.
constexpr std::int64_t kFixedTerminal = 1 << 28;

}  // namespace

CutSolver::CutSolver(const GaussianCloud& cloud, const FlowGraph& graph, CutOptions options)
    : cloud_(cloud), graph_(graph), options_(options) {}

void CutSolver::make_ready() {
  if (max_flow_ || options_.coarse) return;
  capacity_ = arc_capacities(cloud_, graph_, options_.energy);
  max_flow_ = std::make_unique<MaxFlow>(graph_, capacity_);
}

void CutSolver::set_options(const CutOptions& options) {
  const NeighbourOptions before = options_.energy, &now = options.energy;
  options_ = options;
  if (!max_flow_ || before == now) return;
  std::vector<std::int32_t> capacity = arc_capacities(cloud_, graph_, now);
  max_flow_->set_capacity(capacity);
  capacity_ = std::move(capacity);
}

CutReport CutSolver::solve(const Likelihood& likelihood, int views, double pixels_per_view, const Job& job,
                           std::span<const std::int8_t> fixed) {
  CutReport report;
  if (options_.coarse) {
    report.labels.resize(cloud_.size());
    for (std::size_t g = 0; g < cloud_.size(); ++g)
      report.labels[g] = !fixed.empty() && fixed[g] ? fixed[g] > 0 : likelihood.w[g] > options_.tau;
    return report;
  }
  make_ready();
  Terminals data = terminals(cloud_, likelihood, views, pixels_per_view, options_.energy);
  for (std::size_t g = 0; g < fixed.size(); ++g)
    if (fixed[g]) data.net[g] = fixed[g] * kFixedTerminal;
  max_flow_->set_terminals(data.net);
  const bool solved = max_flow_->solve(job);
  report.labels = max_flow_->source_set();
  report.nodes = graph_.nodes();
  report.arcs = graph_.arcs();
  report.touched = max_flow_->touched();
  const std::int64_t energy = data.base_flow + max_flow_->energy(), flow = data.base_flow + max_flow_->flow();
  report.energy = static_cast<double>(energy) / kCapacityScale;
  report.flow = static_cast<double>(flow) / kCapacityScale;
  if (solved && energy != flow) throw std::logic_error("cut: flow and energy differ");
  return report;
}

}  // namespace splatcut
