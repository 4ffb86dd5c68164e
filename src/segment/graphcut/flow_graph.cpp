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

}  // namespace splatcut
