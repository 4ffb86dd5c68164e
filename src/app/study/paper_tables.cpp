#include "app/study/paper_tables.h"

#include <algorithm>
#include <set>

#include "app/published_scores.h"
#include "app/study/study_html.h"

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
      {"clusters",
       "Number of clusters (of the rest, cluster term on)",
       "takes 1 of the object and 4 of the rest; its published code 5 and 5",
       {}},
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
      {"soft and hard counts",
       "Soft and hard weights",
       "within .005 of one another",
       {{0, "soft"}, {1, "hard"}}},
      {"energy terms", "Terms of the energy left out", "every term helps", {}},
      {"sparse input",
       "Little input, with and without the cut",
       "the cut counts most where there is least",
       {{0, "strokes only"}, {1, "one mask"}, {2, "masks of 13 views"}}},
  };
  return all;
}

std::string head_of(const PaperTable& table, double x) {
  return table.heads.contains(x) ? table.heads.at(x) : fmt::format("{:g}", x);
}

// Rows by series, columns by x; energy terms have a row each and one column.
std::string pivot(const PaperTable& table, const std::vector<SettingScore>& scores) {
  const bool list = table.experiment == "energy terms";
  std::set<double> columns;
  for (const SettingScore& s : scores) columns.insert(list ? 0 : s.x);
  std::vector<std::string> head = {""}, series;
  for (const double x : columns) head.push_back(list ? "image IoU (s)" : head_of(table, x));
  for (const SettingScore& s : scores)
    if (std::ranges::find(series, s.series) == series.end()) series.push_back(s.series);
  std::string html = "<table>" + row_of(head, "th");
  for (const std::string& name : series) {
    std::vector<std::string> row = {name};
    for (const double x : columns) {
      const auto s = std::ranges::find_if(
          scores, [&](const SettingScore& c) { return c.series == name && (list || c.x == x); });
      row.push_back(s == scores.end() ? "" : fmt::format("{:.3f} ({:.2f})", s->iou, s->ms / 1000));
    }
    html += row_of(row);
  }
  return html + "</table>\n";
}

// What was found here, in one sentence a series: where it is best and how much it matters.
std::string found(const PaperTable& table, const std::vector<SettingScore>& scores) {
  std::vector<std::string> series;
  std::string words;
  for (const SettingScore& s : scores)
    if (std::ranges::find(series, s.series) == series.end()) series.push_back(s.series);
  if (table.experiment == "energy terms") {
    const auto of = [&](const std::string& name) {
      return std::ranges::find(scores, name, &SettingScore::series);
    };
    for (const SettingScore& s : scores) {
      const auto all = of(s.series.substr(0, s.series.find(':')) + ": all terms");
      if (all != scores.end() && s.series != all->series)
        words += fmt::format("{}{} {:+.3f}", words.empty() ? "" : ", ", s.series, s.iou - all->iou);
    }
    return words;
  }
  for (const std::string& name : series) {
    const SettingScore *best = nullptr, *worst = nullptr;
    for (const SettingScore& s : scores) {
      if (s.series != name) continue;
      if (!best || s.iou > best->iou) best = &s;
      if (!worst || s.iou < worst->iou) worst = &s;
    }
    words += fmt::format("{}{}: best at {} ({:.3f}), worst at {} ({:.3f})", words.empty() ? "" : "; ", name,
                         head_of(table, best->x), best->iou, head_of(table, worst->x), worst->iou);
  }
  return words;
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
                    fmt::format("{:.2f}", s.ms / 1000)});
  }
  return "<h3>Published and here</h3>\n<p>Other scenes and other masks: compare the order of methods, not "
         "the figures. Run <code>splatcut eval --nvos</code> and <code>--spin-nerf</code> for the same "
         "scenes.</p>\n<table>" +
         row_of({"method", "scenes", "image IoU", "seconds"}, "th") + rows + "</table>\n";
}

}  // namespace

std::string paper_tables(const StudyResults& results) {
  std::string html;
  for (const PaperTable& table : tables()) {
    const std::vector<SettingScore> scores = scores_of(of_experiment(results, table.experiment));
    if (scores.empty()) continue;
    html += "<h3>" + escaped(table.title) + "</h3>\n" + pivot(table, scores) +
            "<p>The paper: " + escaped(table.published) + ". Here: " + escaped(found(table, scores)) +
            ".</p>\n";
  }
  if (!of_experiment(results, "trade-off").empty()) html += yardsticks(results);
  return html.empty() ? html
                      : "<h2>The paper's tables on these scenes</h2>\n<p>Image IoU, mean over the scenes "
                        "(median seconds in brackets).</p>\n" +
                            html;
}

}  // namespace splatcut
