#include "app/lab/study/paper_tables.h"

#include <algorithm>
#include <set>

#include "app/lab/published_scores.h"
#include "app/lab/study/study_markdown.h"

namespace splatcut {

namespace {

struct PaperTable {
  std::string experiment, title, published;
  std::map<double, std::string> heads;  // of columns; the number where there is none
};

const std::vector<PaperTable>& tables() {
  static const std::vector<PaperTable> all = {
      {"views",
       "Number of views (beside the first; 40 are 100 %)",
       "30 views of scenes taken from the front, 40 of others",
       {{2, "2 (5 %)"}, {4, "4 (10 %)"}, {8, "8 (20 %)"}, {20, "20 (50 %)"}, {40, "40 (100 %)"}}},
      {"neighbours", "Number of neighbours", "takes 10; its published code 9", {}},
      {"lambda", "Lambda", "takes 0.5, of its own energy", {}},
      {"gamma of position",
       "Gamma of position",
       "takes 0.1 between neighbours, of squared distances in scene units; ours are of overlaps",
       {}},
      {"gamma of colour", "Gamma of colour", "takes 1", {}},
      {"threshold tau",
       "Threshold against the cut",
       "takes .9 for scenes taken from the front, .3 for others",
       {{0, "the cut"}}},
      {"energy terms", "Terms of the energy left out", "every term helps", {}},
  };
  return all;
}

std::string column_name(const PaperTable& table, double x) {
  return table.heads.contains(x) ? table.heads.at(x) : fmt::format("{:g}", x);
}

// Rows by series, columns by x; energy terms have a row each and one column.
std::string pivot(const PaperTable& table, const std::vector<SettingScore>& scores) {
  const bool list = table.experiment == "energy terms";
  std::set<double> columns;
  for (const SettingScore& s : scores) columns.insert(list ? 0 : s.x);
  std::vector<std::string> head = {""}, series;
  for (const double x : columns) head.push_back(list ? "image IoU (CPU s)" : column_name(table, x));
  for (const SettingScore& s : scores)
    if (std::ranges::find(series, s.series) == series.end()) series.push_back(s.series);
  std::string text = head_of(head);
  for (const std::string& name : series) {
    std::vector<std::string> row = {name};
    for (const double x : columns) {
      const auto s = std::ranges::find_if(
          scores, [&](const SettingScore& c) { return c.series == name && (list || c.x == x); });
      row.push_back(s == scores.end() ? "" : fmt::format("{:.3f} ({:.2f})", s->iou, s->cpu_ms / 1000));
    }
    text += row_of(row);
  }
  return text;
}

// What was published of the benchmarks, and the same methods here: other scenes, so the order counts, not the
// figures.
std::string yardsticks(const StudyResults& results) {
  std::string rows;
  for (const PublishedScore& p : published_scores())
    rows += row_of({p.method, p.benchmark + ", published (" + p.source + ")", p.iou, p.seconds});
  for (const SettingScore& s : scores_of(of_experiment(results, "trade-off"))) {
    const bool preset = s.series == "preset";
    if (!preset && s.series != "usual pipeline") continue;
    const std::string method = s.label == "paper"        ? "GaussianCut's energy, our masks (preset paper)"
                               : s.label == "paper-code" ? "its published code's energy (preset paper-code)"
                               : preset
                                   ? "preset " + s.label
                                   : "GrabCut, optical flow, threshold " + fmt::format("({:g} views)", s.x);
    rows += row_of({method, fmt::format("these scenes ({} runs)", s.runs), iou_text(s.iou),
                    fmt::format("{:.2f}", s.cpu_ms / 1000)});
  }
  return "\n### Published and here\n\nOther scenes and other masks: compare the order of methods, not the "
         "figures. "
         "Run `splatcut-lab eval --nvos` and `--spin-nerf` for the same scenes.\n" +
         head_of({"method", "scenes", "image IoU", "CPU seconds here"}) + rows;
}

}  // namespace

std::string paper_tables(const StudyResults& results) {
  std::string text;
  for (const PaperTable& table : tables()) {
    const std::vector<SettingScore> scores = scores_of(of_experiment(results, table.experiment));
    if (scores.empty()) continue;
    text += "\n### " + table.title + "\n" + pivot(table, scores) + "\nThe paper: " + table.published + ".\n";
  }
  if (!of_experiment(results, "trade-off").empty()) text += yardsticks(results);
  if (text.empty()) return text;
  return "\n## The paper's tables on these scenes\n\nImage IoU, mean over the scenes (median CPU seconds in "
         "brackets).\n" +
         text;
}

}  // namespace splatcut
