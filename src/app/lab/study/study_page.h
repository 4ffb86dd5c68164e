// The study as files to read: results.csv, and a page of Markdown that names charts and pictures.
#pragma once

#include <string>
#include <vector>

#include "app/lab/study/study_charts.h"
#include "app/lab/study/study_tables.h"

namespace splatcut {

struct WorstCase {
  std::string caption;
  std::string picture;  // a file beside the page
};

// One row a measurement, one column a number or setting.
std::string study_csv(const StudyResults& results);

// charts: files of the folder "charts" beside the page. machine: a sentence.
std::string study_page(const StudyResults& results, const std::vector<ChartName>& charts,
                       const std::vector<WorstCase>& worst, const std::string& machine);

}  // namespace splatcut
