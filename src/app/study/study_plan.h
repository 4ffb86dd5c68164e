// What the study measures: the stated grid.
#pragma once

#include <vector>

#include "app/study/study_cell.h"

namespace splatcut {

// draws: of the unsteady robot, per scene. quick: few cells of each experiment, for a smoke test of ten minutes.
std::vector<StudyCell> study_plan(int draws, bool quick);

}  // namespace splatcut
