#include "segment/graphcut/flow_graph.h"

#include <algorithm>
#include <cassert>

namespace splatcut {

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

}  // namespace splatcut
