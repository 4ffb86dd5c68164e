// The study's charts as gnuplot scripts, without terminal and output.
#pragma once

#include <string>

#include "app/study/study_charts.h"
#include "app/study/study_plan.h"
#include "app/study/study_tables.h"

namespace splatcut {

struct Drawing {
  StudyChart chart;
  std::string data, body;
  int width_px = 900, height_px = 520;
};

std::string quoted(const std::string& text);  // a gnuplot string

Drawing draw_trade_off(const StudyResults& results);
Drawing draw_stages(const StudyResults& results);  // shares of the time
// IoU over x, one line a series: the mean.
Drawing draw_lines(const StudyResults& results, StudyChart chart, const std::string& x_label,
                   const std::string& more);
// Of scenes and draws: the median, and the band from the 10th to the 90th percentile; the least dotted.
Drawing draw_bands(const StudyResults& results, const StabilityAxis& axis);
// The 10th percentile, one line a kind of wrong mask, with the cut and with a threshold.
Drawing draw_bad_masks(const StudyResults& results, const StabilityAxis& axis);
// One bar a series.
Drawing draw_bars(const StudyResults& results, StudyChart chart);

}  // namespace splatcut
