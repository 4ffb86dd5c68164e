// The charts of a study, drawn by gnuplot: SVG and PNG, and the script that draws them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/study_tables.h"

namespace splatcut {

struct StudyChart {
  std::string name, title;  // name.svg, name.png, name.gp in the folder
};

// Charts for which there are results. Throws Error where a file cannot be written, or gnuplot is not there or
// fails.
std::vector<StudyChart> draw_study_charts(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace splatcut
