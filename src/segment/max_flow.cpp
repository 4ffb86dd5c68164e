#include "segment/max_flow.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace splatcut {

namespace {

constexpr std::uint32_t kNoArc = 0xffffffffu, kTerminal = 0xfffffffeu, kOrphan = 0xfffffffdu;
constexpr std::uint32_t kInfinite = 0x7fffffffu;
enum Tree : std::uint8_t { kFree, kSource, kSink };

class Solver {
 public:
  Solver(const FlowGraph& graph, std::span<const std::int32_t> capacity, std::span<const std::int64_t> terminal)
      : graph_(graph), residual_(capacity.begin(), capacity.end()), terminal_(terminal.begin(), terminal.end()),
        tree_(graph.nodes(), kFree), parent_(graph.nodes(), kNoArc), distance_(graph.nodes(), 0),
        stamp_(graph.nodes(), 0), queued_(graph.nodes(), 0) {}

  std::int64_t solve(const Job& job);
  std::vector<std::uint8_t> minimal_source_set() const;

 private:
  void plant();
  void activate(std::uint32_t node);
  bool next_active(std::uint32_t* node);
  std::uint32_t grow(std::uint32_t node);
  void augment(std::uint32_t bridge);
  std::int64_t bottleneck(std::uint32_t bridge) const;
  void push_along_source(std::uint32_t node, std::int64_t amount);
  void push_along_sink(std::uint32_t node, std::int64_t amount);
  void make_orphan(std::uint32_t node);
  void adopt();
  void adopt(std::uint32_t node);
  std::uint32_t root_distance(std::uint32_t node);
  void mark_path(std::uint32_t node, std::uint32_t distance);

  // The arc of `node`'s tree edge in the direction in which flow runs: towards the node in the source
  // tree, away from it in the sink tree. parent_ holds the arc node -> parent.
  std::int32_t& tree_residual(std::uint32_t arc_of_node, Tree tree) {
    return residual_[tree == kSource ? graph_.reverse_arc[arc_of_node] : arc_of_node];
  }

  const FlowGraph& graph_;
  std::vector<std::int32_t> residual_;
  std::vector<std::int64_t> terminal_;
  std::vector<std::uint8_t> tree_;
  std::vector<std::uint32_t> parent_, distance_, stamp_;
  std::vector<std::uint8_t> queued_;
  std::vector<std::uint32_t> active_, next_round_;
  std::size_t active_at_ = 0;
  std::vector<std::uint32_t> orphans_;
  std::size_t orphan_at_ = 0;
  std::uint32_t time_ = 0;
  std::int64_t flow_ = 0;
};

void Solver::activate(std::uint32_t node) {
  if (queued_[node]) return;
  queued_[node] = 1;
  next_round_.push_back(node);
}

bool Solver::next_active(std::uint32_t* node) {
  for (;;) {
    if (active_at_ == active_.size()) {
      active_.swap(next_round_);
      next_round_.clear();
      active_at_ = 0;
      if (active_.empty()) return false;
    }
    *node = active_[active_at_++];
    queued_[*node] = 0;
    if (tree_[*node] != kFree) return true;
  }
}

void Solver::plant() {
  for (std::uint32_t node = 0; node < graph_.nodes(); ++node) {
    if (terminal_[node] == 0) continue;
    tree_[node] = terminal_[node] > 0 ? kSource : kSink;
    parent_[node] = kTerminal;
    distance_[node] = 1;
    activate(node);
  }
}

// Takes free neighbours into node's tree; returns the arc source side -> sink side where the trees meet.
std::uint32_t Solver::grow(std::uint32_t node) {
  const auto tree = static_cast<Tree>(tree_[node]);
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t reverse = graph_.reverse_arc[arc];
    if (residual_[tree == kSource ? arc : reverse] == 0) continue;
    const std::uint32_t other = graph_.head[arc];
    if (tree_[other] == kFree) {
      tree_[other] = tree;
      parent_[other] = reverse;
      distance_[other] = distance_[node] + 1;
      stamp_[other] = stamp_[node];
      activate(other);
    } else if (tree_[other] != tree) {
      return tree == kSource ? arc : reverse;
    } else if (stamp_[other] <= stamp_[node] && distance_[other] > distance_[node] + 1) {
      parent_[other] = reverse;  // a shorter way to the root
      distance_[other] = distance_[node] + 1;
      stamp_[other] = stamp_[node];
    }
  }
  return kNoArc;
}

std::int64_t Solver::bottleneck(std::uint32_t bridge) const {
  std::int64_t amount = residual_[bridge];
  std::uint32_t node = graph_.head[graph_.reverse_arc[bridge]];
  for (; parent_[node] != kTerminal; node = graph_.head[parent_[node]])
    amount = std::min<std::int64_t>(amount, residual_[graph_.reverse_arc[parent_[node]]]);
  amount = std::min(amount, terminal_[node]);
  for (node = graph_.head[bridge]; parent_[node] != kTerminal; node = graph_.head[parent_[node]])
    amount = std::min<std::int64_t>(amount, residual_[parent_[node]]);
  return std::min(amount, -terminal_[node]);
}

void Solver::make_orphan(std::uint32_t node) {
  parent_[node] = kOrphan;
  orphans_.push_back(node);
}

void Solver::push_along_source(std::uint32_t node, std::int64_t amount) {
  const auto units = static_cast<std::int32_t>(amount);
  while (parent_[node] != kTerminal) {
    const std::uint32_t up = parent_[node], down = graph_.reverse_arc[up], next = graph_.head[up];
    residual_[up] += units;
    residual_[down] -= units;
    if (residual_[down] == 0) make_orphan(node);
    node = next;
  }
  terminal_[node] -= amount;
  if (terminal_[node] == 0) make_orphan(node);
}

void Solver::push_along_sink(std::uint32_t node, std::int64_t amount) {
  const auto units = static_cast<std::int32_t>(amount);
  while (parent_[node] != kTerminal) {
    const std::uint32_t up = parent_[node], next = graph_.head[up];
    residual_[graph_.reverse_arc[up]] += units;
    residual_[up] -= units;
    if (residual_[up] == 0) make_orphan(node);
    node = next;
  }
  terminal_[node] += amount;
  if (terminal_[node] == 0) make_orphan(node);
}

void Solver::augment(std::uint32_t bridge) {
  const std::int64_t amount = bottleneck(bridge);
  const std::uint32_t back = graph_.reverse_arc[bridge];
  residual_[bridge] -= static_cast<std::int32_t>(amount);
  residual_[back] += static_cast<std::int32_t>(amount);
  push_along_source(graph_.head[back], amount);
  push_along_sink(graph_.head[bridge], amount);
  flow_ += amount;
}

// Steps from node to its root, or kInfinite where the path ends in an orphan.
std::uint32_t Solver::root_distance(std::uint32_t node) {
  std::uint32_t steps = 0;
  for (;; node = graph_.head[parent_[node]]) {
    if (stamp_[node] == time_) return steps + distance_[node];
    ++steps;
    if (parent_[node] == kTerminal) {
      stamp_[node] = time_;
      distance_[node] = 1;
      return steps;
    }
    if (parent_[node] == kOrphan || parent_[node] == kNoArc) return kInfinite;
  }
}

void Solver::mark_path(std::uint32_t node, std::uint32_t distance) {
  for (; stamp_[node] != time_; node = graph_.head[parent_[node]]) {
    stamp_[node] = time_;
    distance_[node] = distance--;
  }
}

void Solver::adopt(std::uint32_t node) {
  const auto tree = static_cast<Tree>(tree_[node]);
  std::uint32_t best_arc = kNoArc, best = kInfinite;
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t other = graph_.head[arc];
    if (tree_[other] != tree || tree_residual(arc, tree) == 0) continue;
    const std::uint32_t distance = root_distance(other);
    if (distance == kInfinite) continue;
    mark_path(other, distance);
    if (distance >= best) continue;
    best = distance;
    best_arc = arc;
  }
  parent_[node] = best_arc;
  if (best_arc != kNoArc) {
    stamp_[node] = time_;
    distance_[node] = best + 1;
    return;
  }
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t other = graph_.head[arc];
    if (tree_[other] != tree) continue;
    if (tree_residual(arc, tree) > 0) activate(other);
    const std::uint32_t up = parent_[other];
    if (up < kOrphan && graph_.head[up] == node) make_orphan(other);
  }
  tree_[node] = kFree;
}

void Solver::adopt() {
  while (orphan_at_ < orphans_.size()) adopt(orphans_[orphan_at_++]);
  orphans_.clear();
  orphan_at_ = 0;
}

std::int64_t Solver::solve(const Job& job) {
  plant();
  std::uint32_t node = 0, rounds = 0;
  while (next_active(&node)) {
    if ((++rounds & 0xfff) == 0 && job.cancelled()) return flow_;
    for (std::uint32_t bridge; tree_[node] != kFree && (bridge = grow(node)) != kNoArc;) {
      ++time_;
      augment(bridge);
      adopt();
    }
  }
  return flow_;
}

std::vector<std::uint8_t> Solver::minimal_source_set() const {
  std::vector<std::uint8_t> reached(graph_.nodes(), 0);
  std::vector<std::uint32_t> open;
  for (std::uint32_t node = 0; node < graph_.nodes(); ++node)
    if (terminal_[node] > 0) {
      reached[node] = 1;
      open.push_back(node);
    }
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
      const std::uint32_t other = graph_.head[arc];
      if (residual_[arc] == 0 || reached[other]) continue;
      reached[other] = 1;
      open.push_back(other);
    }
  }
  return reached;
}

}  // namespace

FlowGraph graph_from_edges(std::size_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges,
                           std::vector<std::uint32_t>* arc_of_edge) {
  FlowGraph graph;
  graph.first_arc.assign(nodes + 1, 0);
  for (const auto& [a, b] : edges) {
    assert(a != b && a < nodes && b < nodes);
    ++graph.first_arc[a + 1];
    ++graph.first_arc[b + 1];
  }
  for (std::size_t n = 0; n < nodes; ++n) graph.first_arc[n + 1] += graph.first_arc[n];
  graph.head.resize(2 * edges.size());
  graph.reverse_arc.resize(2 * edges.size());
  if (arc_of_edge) arc_of_edge->resize(edges.size());
  std::vector<std::uint32_t> next(graph.first_arc.begin(), graph.first_arc.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    const std::uint32_t there = next[a]++, back = next[b]++;
    graph.head[there] = b;
    graph.head[back] = a;
    graph.reverse_arc[there] = back;
    graph.reverse_arc[back] = there;
    if (arc_of_edge) (*arc_of_edge)[e] = there;
  }
  return graph;
}

std::int64_t cut_energy(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                        std::span<const std::int64_t> terminal, std::span<const std::uint8_t> source_side) {
  std::int64_t energy = 0;
  for (std::size_t node = 0; node < graph.nodes(); ++node) {
    const std::int64_t b = terminal[node];
    energy += source_side[node] ? std::max<std::int64_t>(-b, 0) : std::max<std::int64_t>(b, 0);
    if (!source_side[node]) continue;
    for (std::uint32_t arc = graph.first_arc[node]; arc < graph.first_arc[node + 1]; ++arc)
      if (!source_side[graph.head[arc]]) energy += arc_capacity[arc];
  }
  return energy;
}

MinCutReport min_cut(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                     std::span<const std::int64_t> terminal, std::int64_t base_flow, const Job& job) {
  assert(arc_capacity.size() == graph.arcs() && terminal.size() == graph.nodes());
  Solver solver(graph, arc_capacity, terminal);
  MinCutReport report;
  report.flow = base_flow + solver.solve(job);
  report.source_side = solver.minimal_source_set();
  report.energy = base_flow + cut_energy(graph, arc_capacity, terminal, report.source_side);
  if (!job.cancelled() && report.flow != report.energy) throw std::logic_error("min_cut: flow and energy differ");
  return report;
}

}  // namespace splatcut
