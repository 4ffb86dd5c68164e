#include "segment/cut.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>

namespace splatcut {

CutSolver::CutSolver(const GaussianCloud& cloud, const FlowGraph& graph, CutOptions options)
    : cloud_(cloud), graph_(graph), options_(options) {}

CutReport CutSolver::solve(const Likelihood& likelihood, int views, double pixels_per_view, const Job& job) {
  CutReport report;
  if (options_.coarse) {
    report.labels.resize(cloud_.size());
    for (std::size_t g = 0; g < cloud_.size(); ++g) report.labels[g] = likelihood.w[g] > options_.tau;
    return report;
  }
  if (!max_flow_) {
    capacity_ = arc_capacities(cloud_, graph_, options_.energy);
    max_flow_ = std::make_unique<MaxFlow>(graph_, capacity_);
  }
  const Terminals data = terminals(cloud_, likelihood, views, pixels_per_view, options_.energy);
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

Confidence CutSolver::confidence() const {
  assert(max_flow_);
  constexpr std::size_t kChunk = 8192;
  const std::size_t n = cloud_.size();
  Confidence out{std::vector<float>(n), std::vector<float>(n)};
  tbb::parallel_for(std::size_t{0}, (n + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t g = chunk * kChunk; g < std::min(n, (chunk + 1) * kChunk); ++g) {
      const FlipCost cost = max_flow_->flip_cost(static_cast<std::uint32_t>(g));
      out.at_least[g] = static_cast<float>(static_cast<double>(cost.at_least) / kCapacityScale);
      out.at_most[g] = static_cast<float>(static_cast<double>(cost.at_most) / kCapacityScale);
    }
  });
  return out;
}

}  // namespace splatcut
