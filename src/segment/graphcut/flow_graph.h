// A directed graph in compressed rows with paired arcs: what the maximum flow runs on.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace splatcut {

struct FlowGraph {
  std::vector<std::uint32_t> first_arc;    // nodes + 1
  std::vector<std::uint32_t> head;         // per arc: the node it leads to
  std::vector<std::uint32_t> reverse_arc;  // per arc: the arc the other way
  std::uint32_t listed = 0;  // k-NN graphs: so many first arcs of a node lead to its own neighbours
  std::size_t nodes() const { return first_arc.empty() ? 0 : first_arc.size() - 1; }
  std::size_t arcs() const { return head.size(); }
};

// A graph of undirected edges {a, b}, a != b, each given once; arcs of a node in the order of the edges.
FlowGraph graph_from_edges(std::size_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges,
                           std::vector<std::uint32_t>* arc_of_edge = nullptr);

}  // namespace splatcut
