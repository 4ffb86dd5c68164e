// The charts of a study.
#pragma once

#include <filesystem>
#include <vector>

#include "app/lab/chart.h"
#include "app/lab/study/study_tables.h"

namespace splatcut {

// Charts for which there are results. Throws Error where a file cannot be written, or gnuplot is not there or
// fails.
std::vector<ChartName> draw_study_charts(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace splatcut
