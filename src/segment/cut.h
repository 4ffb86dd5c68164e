// Labels from likelihood and graph: the exact minimum of the energy, or the paper's coarse threshold.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/energy.h"

namespace splatcut {

struct CutOptions {
  EnergyOptions energy;
  bool coarse = false;  // label = w_g > tau instead of the cut
  float tau = 0.5f;
};

struct CutReport {
  std::vector<std::uint8_t> labels;  // 1 = object
  std::size_t nodes = 0, arcs = 0;   // 0 for coarse
  double energy = 0, flow = 0;       // in units of the energy; equal, for coarse 0
};

// capacity: arc_capacities() of the same options, computed once per scene and options; may be empty (computed here).
CutReport cut_object(const GaussianCloud& cloud, const FlowGraph& graph, std::span<const std::int32_t> capacity,
                     const Likelihood& likelihood, int views, double pixels_per_view, const CutOptions& options,
                     const Job& job = {});

}  // namespace splatcut
