// From psi to arcs, for the files of terms/. Internal to src/segment/graphcut.
#pragma once

#include <algorithm>
#include <cmath>

#include "segment/graphcut/energy.h"

namespace splatcut {

// lambda psi as an integer capacity.
inline std::int32_t capacity_of(float psi, float lambda) {
  constexpr double kLargest = (1 << 30) - 1;  // of the maximum flow
  const double capacity =
      static_cast<double>(lambda) * static_cast<double>(std::isfinite(psi) ? psi : 0.0f) * kCapacityScale;
  return static_cast<std::int32_t>(std::llround(std::min(capacity, kLargest)));
}

// Calls work(edge) for the arcs of the nodes from..to that lead to a later node: each edge once.
template <class Work>
void for_edges(const FlowGraph& graph, std::size_t from, std::size_t to, const Work& work) {
  for (std::size_t g = from; g < to; ++g)
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc)
      if (graph.head[arc] > g) work(Edge{arc, g, graph.head[arc]});
}

}  // namespace splatcut
