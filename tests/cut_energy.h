// The energy that a minimum cut has the least of, by its definition.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "segment/graphcut/flow_graph.h"

namespace splatcut::testing {

// The energy of a labelling:
//   sum over arcs from the source side to the rest of capacity
//   + sum over the rest of max(b, 0) + sum over the source side of max(-b, 0).
// arc_capacity: per arc, >= 0. terminal: b per node, source arc minus sink arc. source_side: per node, 0
// or 1.
inline std::int64_t cut_energy(const FlowGraph& graph, std::span<const std::int32_t> arc_capacity,
                               std::span<const std::int64_t> terminal,
                               std::span<const std::uint8_t> source_side) {
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

}  // namespace splatcut::testing
