// Exact minimum cut of a graph with integer capacities, solved again at little cost when capacities change.
// Knows nothing of Gaussians.
//
// In: a FlowGraph; c, a capacity per arc (0 <= c < 2^30); b, the net terminal capacity per node: source arc
// minus sink arc. Out: the minimal source set (what the sources still reach), which is unique, so labels do
// not depend on the order of work or on what was solved before; the flow, in 64 bits.
//
// State: a pseudoflow f with residuals r = c - f >= 0 and the excess e(v) = b(v) - outflow(v). For every node
// set S
//   E(S) = sum_v max(b, 0) - sum_{v in S} e(v) + sum of r over the arcs that leave S,
// so S is minimum where no residual arc leaves it, every e > 0 is inside and every e < 0 outside. The
// identity holds for any f within the capacities: changes of b only change e, and what was found stays of
// use. Search: two forests of residual arcs. One grows from the nodes with e > 0, lowest label first; the
// other hangs on the nodes with e < 0, which stand ready as roots and are only looked at where the first
// forest arrives: nodes far from any excess are never touched. Labels rise strictly from root to leaf, so no
// cycle can arise; where an augmented path or a change cuts a node off, it takes a neighbour with a lower
// label as its parent, or the lowest one with a label risen above it, or leaves its forest. The nodes touched
// are the sub-graph that the solve needed; certified() proves from them alone that the cut is minimal in the
// whole graph.
//
// Source: Boykov, Kolmogorov, 2004 (forests, orphans); Goldberg, Hed, Kaplan, Kohli, Tarjan, Werneck, Faster
// and more dynamic maximum flow by incremental breadth-first search, 2015 (labels, pseudoflow); Kohli, Torr,
// Dynamic graph cuts, 2007 (residual state kept). Ours: growth from excess only, and the growth in order of
// labels after a change. Cost: near linear in the nodes touched on k-NN graphs. Memory: 17 bytes a node and 4
// an arc beside graph and capacities. Errors: shapes are asserted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/job.h"
#include "segment/graphcut/flow_graph.h"

namespace splatcut {

class MaxFlow {
 public:
  // All b = 0. graph and capacity must outlive this and stay as they are.
  MaxFlow(const FlowGraph& graph, std::span<const std::int32_t> capacity);

  // Any number of changes between two solves, in any order. |b| <= kLargestTerminal.
  static constexpr std::int64_t kLargestTerminal = 1 << 29;
  void set_terminal(std::uint32_t node, std::int64_t b);
  void set_terminals(std::span<const std::int64_t> b);  // of all nodes
  // Other capacities on the same graph. The flow is kept: what no longer fits through an arc stays as excess
  // before it and is lacking behind it. Where that is more than a node can hold, the next solve starts cold.
  void set_capacity(std::span<const std::int32_t> capacity);

  // False when cancelled: the sides are then unspecified, another solve() goes on.
  bool solve(const Job& job = {});
  void restart();  // forgets the flow: the next solve starts cold

  // After solve():
  bool source_side(std::uint32_t node) const { return node_[node].label > 0; }
  std::vector<std::uint8_t> source_set() const;
  std::int64_t flow() const { return positive_b_ - positive_excess_; }
  std::int64_t energy() const;  // of the source set, from b and c alone
  bool certified() const;       // the optimality conditions above, over the nodes touched
  std::size_t touched() const { return touched_.size(); }
  std::size_t cold_starts() const { return cold_starts_; }

 private:
  static constexpr std::uint32_t kOrphan = 0xffffffffu, kRoot = 0xfffffffeu;

  // label > 0: in the source forest, < 0: in the sink forest, 0: in none; its size rises from root to leaf.
  // parent: the arc to the parent, kRoot or kOrphan.
  struct Node {
    std::int32_t excess =
        0;  // roots only send or take what is theirs: never beyond three times the largest terminal
    std::uint32_t parent = kRoot;
    std::int32_t label = 0;
  };

  void touch(std::uint32_t node);
  void activate(std::uint32_t node);
  bool next_active(std::uint32_t* node);
  void scan(std::uint32_t node);
  std::int32_t bottleneck(std::uint32_t node, std::uint32_t bridge) const;
  void augment(std::uint32_t node, std::uint32_t bridge);
  void push_from_source(std::uint32_t node, std::int32_t amount);
  void push_to_sink(std::uint32_t node, std::int32_t amount);
  void orphan_source(std::uint32_t node);
  void orphan_sink(std::uint32_t node);
  void adopt_orphans();
  void adopt_source(std::uint32_t node);
  void adopt_sink(std::uint32_t node);
  void leave_source_forest(std::uint32_t node);
  void leave_sink_forest(std::uint32_t node);
  void reset_arcs_of_touched();
  bool take_back(std::uint32_t node, std::uint32_t arc);
  void clear_lists();
  void plant(std::uint32_t node);
  bool over_budget() const;

  const FlowGraph& graph_;
  std::span<const std::int32_t> capacity_;
  std::vector<std::int32_t> residual_;
  std::vector<Node> node_;
  std::vector<std::int32_t> b_;
  std::vector<std::uint8_t> flags_;                 // kActive, kTouched
  std::vector<std::uint32_t> touched_;              // nodes whose state is not what their b alone says
  std::vector<std::vector<std::uint32_t>> active_;  // by label: source nodes whose arcs are to be looked at
  std::size_t lowest_active_ = 0;
  std::int32_t highest_label_ = 1;  // that of the node being scanned: adoption gives none above the next
  std::vector<std::uint32_t> source_orphans_, sink_orphans_;
  std::int64_t positive_b_ = 0, positive_excess_ = 0;
  std::size_t work_ = 0, work_when_cold_ = 0;  // nodes scanned and adopted by a solve
  std::size_t cold_starts_ = 0;
  bool warm_ = false;
};

struct MinCutReport {
  std::vector<std::uint8_t> source_side;  // 1: in the minimal source set
  std::int64_t flow = 0;
  std::int64_t energy = 0;  // recomputed from source_side
};

// One cold solve. base_flow: what was subtracted from both terminals of nodes to make `terminal` net.
MinCutReport min_cut(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                     std::span<const std::int64_t> terminal, std::int64_t base_flow = 0, const Job& job = {});

}  // namespace splatcut
