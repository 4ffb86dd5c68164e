#include "app/study/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>

#include "app/study/paper_tables.h"
#include "app/study/study_html.h"
#include "app/study/study_plan.h"
#include "scene/error.h"

namespace splatcut {

namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path.string(), "cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string table_of(const StudyResults& results) {
  std::string html =
      "<table>" +
      row_of({"series", "x", "setting", "image IoU", "least", "boundary", "Gaussian", "ms", "runs"}, "th");
  for (const SettingScore& s : scores_of(results))
    html += row_of({s.series, fmt::format("{:g}", s.x), s.label, iou_text(s.iou), iou_text(s.least),
                    iou_text(s.boundary), iou_text(s.gaussian_iou), fmt::format("{:.0f}", s.ms),
                    std::to_string(s.runs)});
  return html + "</table>\n";
}

// Of all scenes, then of each.
std::string spread_table(const StudyResults& results) {
  std::string html = "<table>" + row_of({"series", "x", "scene", "least", "10 %", "median", "90 %", "runs",
                                         "failed", "of those warned", "warned though fine"},
                                        "th");
  const auto add = [&](const StudyResults& some, const std::string& scene) {
    for (const SettingScore& s : scores_of(some))
      html += row_of({s.series, fmt::format("{:g}", s.x), scene, iou_text(s.least), iou_text(s.p10),
                      iou_text(s.median), iou_text(s.p90), std::to_string(s.runs), std::to_string(s.failed),
                      std::to_string(s.failed_warned), std::to_string(s.fine_warned)});
  };
  add(results, "all");
  std::map<std::string, StudyResults> by_scene;
  for (const nlohmann::json& r : results) by_scene[r.at("scene")].push_back(r);
  if (by_scene.size() > 1)
    for (const auto& [scene, some] : by_scene) add(some, scene);
  return html + "</table>\n";
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
             "<h2>What fails, and is it said?</h2>\n<p>Failed: image IoU below {}. Said: the program called "
             "the click ambiguous, found nothing, or left views out because they disagree.</p>\n",
             kFails) +
         "<table>" +
         row_of({"experiment", "series", "x", "failed", "of those said", "least", "10 %", "median", "90 %"},
                "th") +
         rows + "</table>\n";
}

std::string csv_field(const nlohmann::json& value) {
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
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
                                   "ms",
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
    for (const char* column : kColumns) row.append(row.empty() ? "" : ",").append(csv_field(r.at(column)));
    csv += row + "\n";
  }
  return csv;
}

std::string study_page(const StudyResults& results, const std::vector<StudyChart>& charts,
                       const std::filesystem::path& chart_folder, const std::vector<WorstCase>& worst,
                       const std::string& machine) {
  std::string html =
      "<!doctype html><html lang=en><meta charset=utf-8><title>splatcut "
      "study</title><style>body{font:15px/1.5 sans-serif;max-width:1040px;margin:2em auto;"
      "padding:0 1em;color:#222}img{max-width:100%}table{border-collapse:collapse;font-size:13px;margin:1em "
      "0}td,th{border:1px solid #ccc;padding:2px 8px;"
      "text-align:right}td:nth-child(-n+3){text-align:left}figure{display:inline-block;width:320px;margin:"
      "4px;vertical-align:top}</style>\n<h1>Study</h1>\n";
  html += fmt::format("<p>{}. {} measurements.</p>\n", escaped(machine), results.size());
  for (const StudyChart& chart : charts)
    html += fmt::format("<h2>{}</h2><img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">\n",
                        escaped(chart.title), escaped(chart.title),
                        base64(bytes_of(chart_folder / (chart.name + ".svg"))));
  if (!worst.empty()) html += "<h2>Where it failed worst</h2>\n";
  for (const WorstCase& w : worst)
    html += fmt::format(
        "<figure><img alt=\"\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
        base64(bytes_of(w.png)), escaped(w.caption));
  html += failure_table(results) + paper_tables(results);
  for (const std::string& experiment : experiments_of(results)) {
    const StudyResults some = of_experiment(results, experiment);
    html += "<h2>" + escaped(experiment) + "</h2>\n" +
            (is_stability(experiment) ? spread_table(some) : table_of(some));
  }
  return html + "</html>\n";
}

}  // namespace splatcut
