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
  std::string text = head_of({"series", "x", "scene", "least", "10 %", "median", "mean", "runs", "failed",
                              "of those said", "said though fine"});
  const auto add = [&](const StudyResults& some, const std::string& scene) {
    for (const SettingScore& s : scores_of(some))
      text += row_of({s.series, fmt::format("{:g}", s.x), scene, iou_text(s.least), iou_text(s.p10),
                      iou_text(s.median), iou_text(s.iou), std::to_string(s.runs), std::to_string(s.failed),
                      std::to_string(s.failed_warned), std::to_string(s.fine_warned)});
  };
  add(results, "all");
  std::map<std::string, StudyResults> by_scene;
  for (const nlohmann::json& r : results) by_scene[r.at("scene")].push_back(r);
  if (by_scene.size() > 1)
    for (const auto& [scene, some] : by_scene) add(some, scene);
  return text;
}

// The draws that fail and nothing is said of.
std::string silence_table(const StudyResults& results) {
  std::string rows;
  for (const StabilityAxis& axis : stability_axes()) {
    StudyResults silent = failing(of_experiment(results, axis.experiment));
    std::erase_if(silent, [](const nlohmann::json& r) { return r.at("warned") != ""; });
    std::map<std::array<std::string, 3>, StudyResults> by_scene;
    for (const nlohmann::json& r : silent)
      by_scene[{r.at("series"), fmt::format("{:g}", r.at("x").get<double>()), r.at("scene")}].push_back(r);
    for (const auto& [at, some] : by_scene) {
      std::string draws;
      for (const nlohmann::json& r : some)
        draws += fmt::format("{}{}: {:.3f}", draws.empty() ? "" : ", ", r.at("draw").get<int>(),
                             r.at("image_iou").get<double>());
      rows += row_of({axis.experiment, at[0], at[1], at[2], draws});
    }
  }
  if (rows.empty()) return {};
  return fmt::format(
             "\n## What fails without a word\n\nImage IoU below {}, and below the best of the scene in the "
             "experiment less {}, and the program said nothing.\n",
             kFails, kNearBest) +
         head_of({"experiment", "series", "x", "scene", "draws"}) + rows;
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
                                   "parts_only",
                                   "masks",
                                   "clicks",
                                   "draw",
                                   "disturbance",
                                   "disturbance_px",
                                   "disturbed_share",
                                   "stroke_px",
                                   "scene_scale",
                                   "up_tilt_deg",
                                   "step_back",
                                   "reordered",
                                   "hidden",
                                   "object_share",
                                   "picture_scale",
                                   "still_life",
                                   "image_iou",
                                   "boundary_iou",
                                   "gaussian_iou",
                                   "cpu_ms",
                                   "views",
                                   "views_left_out",
                                   "gaussians",
                                   "looked_at_mpx",
                                   "certainty",
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
  text += silence_table(results) + paper_tables(results);
  for (const std::string& experiment : experiments_of(results)) {
    const StudyResults some = of_experiment(results, experiment);
    text += "\n## " + experiment + "\n" + (is_stability(experiment) ? spread_table(some) : table_of(some));
  }
  return text;
}

}  // namespace splatcut
