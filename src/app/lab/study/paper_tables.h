// The tables of Jain et al., GaussianCut, NeurIPS 2024, on the scenes of the study: rows and columns as
// there, what it states beside what was measured. Its scenes are others, and of its figures only those are
// quoted that could be read at a source (published_scores.h).
#pragma once

#include <string>

#include "app/lab/study/study_tables.h"

namespace splatcut {

// Markdown; empty where none of them was measured.
std::string paper_tables(const StudyResults& results);

}  // namespace splatcut
