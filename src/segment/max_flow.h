// Exact minimum cut of a graph with integer capacities. Knows nothing of Gaussians.
//
// In: a directed graph in CSR form with paired arcs, a capacity per arc, and per node the net terminal
// capacity b = (source arc) - (sink arc). Out: the side of every node in a minimum cut, its flow, its energy.
//   flow = energy(labels) = base_flow + sum over cut arcs of capacity
//                           + sum over sink-side nodes of max(b, 0) + sum over source-side nodes of max(-b, 0)
// Method: two search trees that grow from the terminals, augment along the path where they meet and adopt
// orphans (Boykov and Kolmogorov, 2004), with distance and time stamps for short paths. Integers: it ends, and
// the minimal source set (what the source still reaches) is the same on every machine.
// Cost: near linear on k-NN graphs; worst case O(arcs nodes^2 flow). Memory: 21 bytes a node, 4 an arc.
// Errors: none; shapes are asserted. flow == energy is checked after every solve.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scene/job.h"

namespace splatcut {

struct FlowGraph {
  std::vector<std::uint32_t> first_arc;    // nodes + 1
  std::vector<std::uint32_t> head;         // per arc: the node it leads to
  std::vector<std::uint32_t> reverse_arc;  // per arc: the arc the other way
  std::size_t nodes() const { return first_arc.empty() ? 0 : first_arc.size() - 1; }
  std::size_t arcs() const { return head.size(); }
};

// A graph of undirected edges {a, b}, a != b, each given once; arcs of a node in the order of the edges.
FlowGraph graph_from_edges(std::size_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges,
                           std::vector<std::uint32_t>* arc_of_edge = nullptr);

struct MinCutReport {
  std::vector<std::uint8_t> source_side;  // 1: in the minimal source set
  std::int64_t flow = 0;
  std::int64_t energy = 0;                // recomputed from source_side
};

// base_flow: what was subtracted from both terminals of nodes to make `terminal` net.
MinCutReport min_cut(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                     std::span<const std::int64_t> terminal, std::int64_t base_flow = 0, const Job& job = {});

std::int64_t cut_energy(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                        std::span<const std::int64_t> terminal, std::span<const std::uint8_t> source_side);

}  // namespace splatcut
