// What the study measures: the stated grid.
#pragma once

#include <string>
#include <vector>

#include "app/lab/study/study_cell.h"

namespace splatcut {

// draws: of all that is left to chance, per scene and setting. quick: few cells of each experiment, for ten
// minutes.
std::vector<StudyCell> study_plan(int draws, bool quick);

// Those whose result is a distribution over draws: how steady the shipped program is.
bool is_stability(const std::string& experiment);

// What x is, with its unit, and how it is drawn.
struct StabilityAxis {
  std::string experiment, file, title, x_label, gnuplot;
};
const std::vector<StabilityAxis>& stability_axes();

}  // namespace splatcut
