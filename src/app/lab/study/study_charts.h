// The charts of a study: points as CSV, the gnuplot script that draws them, SVG and PNG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/lab/study/study_tables.h"

namespace splatcut {

struct StudyChart {
  std::string name, title;  // name.csv, name.gp, name.svg, name.png in the folder
};

// Charts for which there are results. Throws Error where a file cannot be written, or gnuplot is not there or
// fails.
std::vector<StudyChart> draw_study_charts(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace splatcut
