// What surrounds the search: changes of capacities, reports, bounds, undo.
#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <stdexcept>

#include "segment/graphcut/max_flow.h"
#include "segment/graphcut/max_flow_flags.h"

namespace splatcut {

namespace {

constexpr std::int32_t kLargestExcess =
    MaxFlow::kLargestTerminal;  // that a change of capacities may leave at a node

}  // namespace

MaxFlow::MaxFlow(const FlowGraph& graph, std::span<const std::int32_t> capacity)
    : graph_(graph),
      capacity_(capacity),
      residual_(capacity.begin(), capacity.end()),
      node_(graph.nodes()),
      b_(graph.nodes(), 0),
      flags_(graph.nodes(), 0) {
  assert(capacity.size() == graph.arcs());
}

void MaxFlow::touch(std::uint32_t node) {
  if (flags_[node] & kTouched) return;
  flags_[node] |= kTouched;
  touched_.push_back(node);
}

// A root of the forest that its excess asks for, or free.
void MaxFlow::plant(std::uint32_t node) {
  Node& n = node_[node];
  n.parent = kRoot;
  n.label = n.excess > 0 ? 1 : n.excess < 0 ? -1 : 0;
  if (n.label > 0) activate(node);
}

void MaxFlow::set_terminal(std::uint32_t node, std::int64_t b) {
  assert(std::abs(b) <= kLargestTerminal);
  if (b == b_[node]) return;
  Node& n = node_[node];
  positive_b_ += std::max<std::int64_t>(b, 0) - std::max(b_[node], 0);
  positive_excess_ -= std::max(n.excess, 0);
  n.excess += static_cast<std::int32_t>(b - b_[node]);
  b_[node] = static_cast<std::int32_t>(b);
  positive_excess_ += std::max(n.excess, 0);
  if (n.excess > 0) {
    if (n.label < 0) leave_sink_forest(node);
    if (n.label > 0)
      n.parent = kRoot;
    else
      plant(node);
  } else if (n.excess < 0) {
    if (n.label > 0) {
      touch(node);
      leave_source_forest(node);
    }
    if (n.label < 0)
      n.parent = kRoot;
    else
      plant(node);
  } else if (n.parent == kRoot && n.label != 0) {
    n.label > 0 ? orphan_source(node) : orphan_sink(node);
  }
}

void MaxFlow::set_terminals(std::span<const std::int64_t> b) {
  assert(b.size() == b_.size());
  for (std::uint32_t node = 0; node < b.size(); ++node) set_terminal(node, b[node]);
}

void MaxFlow::clear_lists() {
  for (auto& bucket : active_) bucket.clear();
  lowest_active_ = active_.size();
  source_orphans_.clear();
  sink_orphans_.clear();
  for (const std::uint32_t node : touched_) flags_[node] &= static_cast<std::uint8_t>(~kActive);
}

void MaxFlow::reset_arcs_of_touched() {
  for (const std::uint32_t node : touched_)
    for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
      residual_[arc] = capacity_[arc];
      residual_[graph_.reverse_arc[arc]] = capacity_[graph_.reverse_arc[arc]];
    }
}

void MaxFlow::restart() {
  clear_lists();
  reset_arcs_of_touched();
  std::vector<std::uint32_t> touched;
  touched.swap(touched_);
  for (const std::uint32_t node : touched) {
    flags_[node] = 0;
    node_[node].excess = b_[node];
    plant(node);
  }
  positive_excess_ = positive_b_;
  warm_ = false;
}

// The part of the arc's flow that its capacity no longer holds goes back to its node. False where that is too
// much.
bool MaxFlow::take_back(std::uint32_t node, std::uint32_t arc) {
  const std::int32_t beyond = -residual_[arc];
  const std::uint32_t other = graph_.head[arc];
  if (node_[node].excess > kLargestExcess - beyond || node_[other].excess < beyond - kLargestExcess)
    return false;
  residual_[arc] = 0;
  residual_[graph_.reverse_arc[arc]] -= beyond;
  node_[node].excess += beyond;
  node_[other].excess -= beyond;
  touch(node);
  touch(other);
  return true;
}

void MaxFlow::set_capacity(std::span<const std::int32_t> capacity) {
  assert(capacity.size() == graph_.arcs());
  std::int32_t least = 0;
  for (std::size_t arc = 0; arc < capacity.size(); ++arc) {
    residual_[arc] += capacity[arc] - capacity_[arc];
    least = std::min(least, residual_[arc]);
  }
  capacity_ = capacity;
  for (std::size_t i = 0; least < 0 && i < touched_.size();
       ++i)  // touched_ grows: flow lies on arcs of touched nodes
    for (std::uint32_t arc = graph_.first_arc[touched_[i]]; arc < graph_.first_arc[touched_[i] + 1]; ++arc) {
      const std::uint32_t back = graph_.reverse_arc[arc];
      if ((residual_[arc] < 0 && !take_back(touched_[i], arc)) ||
          (residual_[back] < 0 && !take_back(graph_.head[arc], back)))
        return restart();
    }
  // Arcs that were full may be open: the forests are planted anew on the flow that is kept.
  clear_lists();
  positive_excess_ = 0;
  for (std::size_t i = 0, n = touched_.size(); i < n; ++i) {
    positive_excess_ += std::max(node_[touched_[i]].excess, 0);
    plant(touched_[i]);
  }
}

std::vector<std::uint8_t> MaxFlow::source_set() const {
  std::vector<std::uint8_t> side(node_.size());
  std::ranges::transform(node_, side.begin(),
                         [](const Node& n) { return static_cast<std::uint8_t>(n.label > 0); });
  return side;
}

std::int64_t MaxFlow::energy() const {
  std::int64_t energy = 0;  // a node that was never touched has b <= 0 and is not in the source set: nothing
  for (const std::uint32_t node : touched_) {
    if (!source_side(node)) {
      energy += std::max(b_[node], 0);
      continue;
    }
    energy += std::max(-b_[node], 0);
    for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc)
      if (!source_side(graph_.head[arc])) energy += capacity_[arc];
  }
  return energy;
}

bool MaxFlow::certified() const {
  return std::ranges::all_of(touched_, [&](std::uint32_t node) {
    if (!source_side(node)) return node_[node].excess <= 0;
    if (node_[node].excess < 0) return false;
    for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc)
      if (residual_[arc] != 0 && !source_side(graph_.head[arc])) return false;
    return true;
  });
}

MinCutReport min_cut(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                     std::span<const std::int64_t> terminal, std::int64_t base_flow, const Job& job) {
  MaxFlow max_flow(graph, arc_capacity);
  max_flow.set_terminals(terminal);
  const bool solved = max_flow.solve(job);
  MinCutReport report{max_flow.source_set(), base_flow + max_flow.flow(), base_flow + max_flow.energy()};
  if (solved && report.flow != report.energy) throw std::logic_error("min_cut: flow and energy differ");
  return report;
}

}  // namespace splatcut
