// What clicks could have meant, and what each meaning would have been worth: what the costs are fitted to.
//
// In: scenes as their parts, a model. The any-view robot plays its sessions with that model; at every click
// each candidate's terms are noted (selection/candidates.h), and the mean image IoU over all views with truth
// if it were the one. Out: weights of the terms. Cost: some 100 ms a click and view, then seconds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/measure/parts_world.h"
#include "segment/selection/candidates.h"

namespace splatcut {

struct Meaning {
  TermValues terms{};
  float iou = 0;  // mean over the views with truth, after it
};

enum class DecisionOf { kFirstClick, kCorrection, kBox };

struct Decision {
  std::size_t scene = 0;  // which of several, filled by whoever has them
  DecisionOf of = DecisionOf::kFirstClick;
  std::vector<Meaning> meanings;
};

// Of one session from the start. Clicks on what is shown as said already decide nothing.
std::vector<Decision> decisions_of(const PartsScene& scene, const SelectionModel& model,
                                   const AnyViewStart& start, int clicks);

struct TermFitOptions {
  std::uint32_t without = 0;  // bits by Term: their weight stays 0
  int steps = 300;
  float rate = 0.1f;     // a step, in units of a term's spread over the candidates
  float shrink = 1e-3f;  // of the squared weights in those units, against an IoU
};

// Weights with the best expected IoU where a candidate is chosen with a probability ~ exp(-cost): ascent from
// zero by Adam (Kingma and Ba, 2015). Every scene counts alike, however many decisions it has. in_scene: per
// scene, whether it counts. The same data, the same weights.
TermValues fitted_terms(std::span<const Decision> decisions, DecisionOf of, const std::vector<bool>& in_scene,
                        const TermFitOptions& options = {});

}  // namespace splatcut
