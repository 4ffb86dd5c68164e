// Labels from likelihood and graph: the exact minimum of the energy, or the paper's coarse threshold.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "segment/graphcut/energy.h"
#include "segment/graphcut/max_flow.h"

namespace splatcut {

struct CutOptions {
  EnergyOptions energy;
  bool coarse = false;  // label = w_g > tau instead of the cut
  float tau = 0.5f;
  bool operator==(const CutOptions&) const = default;
};

struct CutFigures {
  std::size_t nodes = 0, arcs = 0;  // 0 for coarse
  std::size_t touched = 0;          // nodes of the sub-graph that proves the cut, see max_flow.h
  double energy = 0, flow = 0;      // in units of the energy; equal, for coarse 0
};

struct CutReport : CutFigures {
  std::vector<std::uint8_t> labels;  // 1 = object
};

// The cut of one scene, solved again and again while the likelihood grows: flow and forests stay from one
// solve to the next. Labels are those of a fresh solver, bit for bit. cloud and graph must outlive this and
// stay as they are.
class CutSolver {
 public:
  CutSolver(const GaussianCloud& cloud, const FlowGraph& graph, CutOptions options);

  // Builds now what the first solve would build: a third of that solve's time, or more.
  void make_ready();

  // From the next solve on. The flow stays of use where only weights of the energy change.
  void set_options(const CutOptions& options);

  // views, pixels_per_view: what the likelihood was summed over. Cancelled: the labels are unspecified.
  // fixed: empty, or per Gaussian +1 object, -1 not, 0 open: those are on their side whatever the views say,
  // unless neighbours weigh more than 256 units of energy there.
  CutReport solve(const Likelihood& likelihood, int views, double pixels_per_view, const Job& job = {},
                  std::span<const std::int8_t> fixed = {});

 private:
  const GaussianCloud& cloud_;
  const FlowGraph& graph_;
  CutOptions options_;
  std::vector<std::int32_t> capacity_;  // from the first solve on
  std::unique_ptr<MaxFlow> max_flow_;
};

}  // namespace splatcut
