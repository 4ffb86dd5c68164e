#include "app/lab/study/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "app/lab/study/paper_tables.h"
#include "app/lab/study/study_markdown.h"
#include "app/lab/study/study_plan.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

std::string table_of(const StudyResults& results) {
  std::string text =
      head_of({"series", "x", "setting", "image IoU", "least", "boundary", "Gaussian", "CPU ms", "runs"});
  for (const SettingScore& s : scores_of(results))
    text += row_of({s.series, fmt::format("{:g}", s.x), s.label, iou_text(s.iou), iou_text(s.least),
                    iou_text(s.boundary), iou_text(s.gaussian_iou), fmt::format("{:.0f}", s.cpu_ms),
                    std::to_string(s.runs)});
  return text;
}

// Of all scenes, then of each.
std::string spread_table(const StudyResults& results) {
  std::string text = head_of({"series", "x", "scene", "least", "10 %", "median", "90 %", "runs", "failed",
                              "of those warned", "warned though fine"});
  const auto add = [&](const StudyResults& some, const std::string& scene) {
    for (const SettingScore& s : scores_of(some))
      text += row_of({s.series, fmt::format("{:g}", s.x), scene, iou_text(s.least), iou_text(s.p10),
                      iou_text(s.median), iou_text(s.p90), std::to_string(s.runs), std::to_string(s.failed),
                      std::to_string(s.failed_warned), std::to_string(s.fine_warned)});
  };
  add(results, "all");
  std::map<std::string, StudyResults> by_scene;
  for (const nlohmann::json& r : results) by_scene[r.at("scene")].push_back(r);
  if (by_scene.size() > 1)
    for (const auto& [scene, some] : by_scene) add(some, scene);
  return text;
}

// The regimes in which something fails, and whether the user is told.
std::string failure_table(const StudyResults& results) {
  std::string rows;
  for (const StabilityAxis& axis : stability_axes())
    for (const SettingScore& s : scores_of(of_experiment(results, axis.experiment)))
      if (s.failed > 0)
        rows += row_of({axis.experiment, s.series, fmt::format("{:g}", s.x),
                        fmt::format("{:.0f} % of {}", 100.0 * s.failed / s.runs, s.runs),
                        fmt::format("{:.0f} %", 100.0 * s.failed_warned / s.failed), iou_text(s.least),
                        iou_text(s.p10), iou_text(s.median), iou_text(s.p90)});
  if (rows.empty()) return {};
  return fmt::format(
             "\n## What fails, and is it said?\n\nFailed: image IoU below {}. Said: the program called the "
             "click ambiguous, found nothing, or left views out because they disagree.\n",
             kFails) +
         head_of(
             {"experiment", "series", "x", "failed", "of those said", "least", "10 %", "median", "90 %"}) +
         rows;
}

std::string text_of(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : json_text(value);
}

}  // namespace

std::string study_csv(const StudyResults& results) {
  constexpr std::array kColumns = {"experiment",
                                   "series",
                                   "x",
                                   "scene",
                                   "preset",
                                   "set",
                                   "first",
                                   "parts_only",
                                   "true_masks",
                                   "clicks",
                                   "draw",
                                   "disturbance",
                                   "disturbance_px",
                                   "disturbed_share",
                                   "stroke_px",
                                   "scene_scale",
                                   "up_tilt_deg",
                                   "step_back",
                                   "order",
                                   "hidden",
                                   "object_share",
                                   "score_scale",
                                   "still_life",
                                   "image_iou",
                                   "boundary_iou",
                                   "gaussian_iou",
                                   "cpu_ms",
                                   "views",
                                   "views_left_out",
                                   "gaussians",
                                   "looked_at_mpx",
                                   "ambiguous",
                                   "warned",
                                   "found"};
  std::string csv;
  for (const char* column : kColumns) csv.append(csv.empty() ? "" : ",").append(column);
  csv += "\n";
  for (const nlohmann::json& r : results) {
    std::string row;
    for (const char* column : kColumns)
      row.append(row.empty() ? "" : ",").append(csv_field(text_of(r.at(column))));
    csv += row + "\n";
  }
  return csv;
}

std::string study_page(const StudyResults& results, const std::vector<ChartName>& charts,
                       const std::vector<WorstCase>& worst, const std::string& machine) {
  std::string text = fmt::format("# Study\n\n{}. {} measurements.\n", machine, results.size());
  for (const ChartName& chart : charts)
    text += fmt::format("\n## {0}\n\n![{0}](charts/{1}.svg)\n", chart.title, chart.name);
  if (!worst.empty()) text += "\n## Where it failed worst\n";
  for (const WorstCase& w : worst) text += fmt::format("\n![worst case]({})\n\n{}\n", w.picture, w.caption);
  text += failure_table(results) + paper_tables(results);
  for (const std::string& experiment : experiments_of(results)) {
    const StudyResults some = of_experiment(results, experiment);
    text += "\n## " + experiment + "\n" + (is_stability(experiment) ? spread_table(some) : table_of(some));
  }
  return text;
}

}  // namespace splatcut
