// The study as files to read: results.csv, tables, and one page that needs nothing beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/study_charts.h"
#include "app/study/study_tables.h"

namespace splatcut {

struct WorstCase {
  std::string caption;
  std::filesystem::path png;
};

// One row a measurement, one column a number or setting.
std::string study_csv(const StudyResults& results);

// charts and pictures are put into the page itself. machine: a sentence.
std::string study_page(const StudyResults& results, const std::vector<StudyChart>& charts,
                       const std::filesystem::path& chart_folder, const std::vector<WorstCase>& worst,
                       const std::string& machine);

}  // namespace splatcut
