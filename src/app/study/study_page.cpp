#include "app/study/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

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
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? std::string("&lt;") : c == '&' ? std::string("&amp;") : std::string(1, c);
  return out;
}

std::string table_of(const StudyResults& results) {
  std::string html = "<table><tr><th>series</th><th>x</th><th>setting</th><th>image IoU</th><th>least</th><th>boundary</th><th>Gaussian</th><th>ms</th><th>n</th></tr>\n";
  for (const SettingScore& s : scores_of(results))
    html += fmt::format("<tr><td>{}</td><td>{:g}</td><td>{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.0f}</td><td>{}</td></tr>\n",
                        escaped(s.series), s.x, escaped(s.label), s.iou, s.least_iou, s.boundary, s.gaussian_iou, s.ms, s.scenes);
  return html + "</table>\n";
}

std::string spread_table(const StudyResults& results) {
  std::string html = "<table><tr><th>scene</th><th>series</th><th>least</th><th>10 %</th><th>median</th><th>90 %</th><th>draws</th></tr>\n";
  for (const Spread& s : spreads_of(results))
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{}</td></tr>\n", escaped(s.scene),
                        escaped(s.series), s.least, s.p10, s.median, s.p90, s.draws);
  return html + "</table>\n";
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
  constexpr std::array kColumns = {"experiment", "series", "x", "scene", "preset", "set", "first", "parts_only", "true_masks", "clicks", "draw", "disturbance",
                                   "disturbance_px", "disturbed_share", "stroke_px", "scene_scale", "up_tilt_deg", "step_back", "image_iou", "boundary_iou",
                                   "gaussian_iou", "ms", "views", "views_left_out", "gaussians", "ambiguous", "found"};
  std::string csv;
  for (const char* column : kColumns) csv += (csv.empty() ? "" : ",") + std::string(column);
  csv += "\n";
  for (const nlohmann::json& r : results) {
    std::string row;
    for (const char* column : kColumns) row += (row.empty() ? "" : ",") + csv_field(r.at(column));
    csv += row + "\n";
  }
  return csv;
}

std::string study_page(const StudyResults& results, const std::vector<StudyChart>& charts, const std::filesystem::path& chart_folder,
                       const std::vector<WorstCase>& worst, const std::string& machine) {
  std::string html =
      "<!doctype html><html lang=en><meta charset=utf-8><title>splatcut study</title><style>body{font:15px/1.5 sans-serif;max-width:1040px;margin:2em auto;"
      "padding:0 1em;color:#222}img{max-width:100%}table{border-collapse:collapse;font-size:13px;margin:1em 0}td,th{border:1px solid #ccc;padding:2px 8px;"
      "text-align:right}td:nth-child(-n+3){text-align:left}figure{display:inline-block;width:320px;margin:4px;vertical-align:top}</style>\n<h1>Study</h1>\n";
  html += fmt::format("<p>{}. {} measurements.</p>\n", escaped(machine), results.size());
  for (const StudyChart& chart : charts)
    html += fmt::format("<h2>{}</h2><img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">\n", escaped(chart.title), escaped(chart.title),
                        base64(bytes_of(chart_folder / (chart.name + ".svg"))));
  if (!worst.empty()) html += "<h2>Where it failed worst</h2>\n";
  for (const WorstCase& w : worst)
    html += fmt::format("<figure><img alt=\"\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n", base64(bytes_of(w.png)), escaped(w.caption));
  std::vector<std::string> experiments;
  for (const nlohmann::json& r : results)
    if (const std::string name = r.at("experiment"); std::ranges::find(experiments, name) == experiments.end()) experiments.push_back(name);
  for (const std::string& experiment : experiments) {
    const StudyResults some = of_experiment(results, experiment);
    html += "<h2>" + escaped(experiment) + "</h2>\n" + (experiment == "click jitter" ? spread_table(some) : table_of(some));
  }
  return html + "</html>\n";
}

}  // namespace splatcut
