#include "app/lab/study/study_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/lab/chart.h"
#include "app/lab/study/study_plan.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace splatcut {

namespace {

std::string label_command(const char* axis, const std::string& text) {
  return text.empty() ? std::string() : fmt::format("set {} {}\n", axis, gnuplot_text(text));
}

std::vector<std::string> series_of(const std::vector<SettingScore>& scores) {
  std::vector<std::string> names;
  for (const SettingScore& s : scores)
    if (std::ranges::find(names, s.series) == names.end()) names.push_back(s.series);
  return names;
}

std::vector<SettingScore> of_series(const std::vector<SettingScore>& scores, const std::string& series) {
  std::vector<SettingScore> own;
  std::ranges::copy_if(scores, std::back_inserter(own),
                       [&](const SettingScore& s) { return s.series == series; });
  std::ranges::stable_sort(own, {}, &SettingScore::x);
  return own;
}

// Columns 1 to 7; the first is headed by the block's name, which becomes its title in the key.
void add_block(const std::string& name, const std::vector<SettingScore>& scores, Chart* chart) {
  chart->blocks = chart->csv.empty() ? 1 : chart->blocks + 1;
  if (!chart->csv.empty()) chart->csv += "\n\n";
  chart->csv += csv_field(name) + ",iou,least,p10,median,cpu_seconds,label\n";
  for (const SettingScore& s : scores)
    chart->csv += fmt::format("{},{},{},{},{},{},{}\n", s.x, s.iou, s.least, s.p10, s.median, s.cpu_ms / 1000,
                              csv_field(s.label));
}

void add_blocks(const std::vector<SettingScore>& scores, Chart* chart) {
  for (const std::string& series : series_of(scores)) add_block(series, of_series(scores, series), chart);
}

Chart trade_off(const StudyResults& results) {
  Chart chart{.named = {"trade_off", "Speed against accuracy"}, .width_px = 1080, .height_px = 680};
  std::vector<SettingScore> scores = scores_of(results), others = scores;
  std::vector<SettingScore> front = pareto_front(scores);
  if (!front.empty()) {  // nothing slower is better
    front.push_back(front.back());
    front.back().cpu_ms = std::ranges::max(scores, {}, &SettingScore::cpu_ms).cpu_ms;
  }
  add_block("Pareto front", front, &chart);
  std::vector<SettingScore> presets = of_series(scores, "preset");
  add_block("presets", presets, &chart);
  std::erase_if(others, [](const SettingScore& s) { return s.series == "preset"; });
  add_blocks(others, &chart);
  chart.commands =
      "set logscale x\nset xlabel 'CPU seconds from strokes to labels (median over the scenes)'\n"
      "set ylabel 'image IoU (mean over the scenes)'\nset yrange [*:1]\n"
      "set offsets graph 0.05, graph 0.05, graph 0.06, graph 0.06\n"
      "plot data index 0 using 6:2 with steps lw 2 lc rgb '#222222' title columnheader(1), \\\n"
      "     for [i=2:last] data index i using 6:2 with points pt i+2 lc i title columnheader(1), \\\n"
      "     data index 1 using 6:2 with points pt 3 ps 2 lw 2 lc rgb '#c00000' title columnheader(1), \\\n"
      "     data index 1 using 6:2:7 with labels offset 0,1 tc rgb '#c00000' notitle\n";
  return chart;
}

// Stacked bars: a row a setting, a column a stage, in percent; what never reaches 1 % is left out.
Chart stages(const StudyResults& results) {
  Chart chart{.named = {"stages", "Where the time goes"}};
  std::map<std::string, double> most;
  std::map<std::string, SettingScore> bars;
  std::vector<std::string> order;
  const auto sum_of = [](const SettingScore& s) {
    double sum = 0;
    for (const auto& [stage, ms] : s.stages) sum += ms;
    return std::max(sum, 1e-6);
  };
  for (const SettingScore& s : scores_of(results)) {
    if (s.series != "preset" && s.series != "usual pipeline" && s.series != "parts alone") continue;
    const std::string name =
        fmt::format("{} {:.0f} ms", s.series == "preset" ? s.label : s.series, sum_of(s));
    if (!bars.emplace(name, s).second) continue;
    order.push_back(name);
    for (const auto& [stage, ms] : s.stages) most[stage] = std::max(most[stage], ms / sum_of(s));
  }
  std::erase_if(most, [](const auto& stage) { return stage.second < 0.01; });
  chart.csv = "setting";
  for (const auto& [stage, share] : most) chart.csv += "," + csv_field(stage);
  for (const std::string& name : order) {
    chart.csv += "\n" + csv_field(name);
    for (const auto& [stage, share] : most) {
      const SettingScore& s = bars.at(name);
      chart.csv += fmt::format(",{}", s.stages.contains(stage) ? 100 * s.stages.at(stage) / sum_of(s) : 0.0);
    }
  }
  chart.csv += "\n";
  chart.commands = fmt::format(
      "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.8 border -1\n"
      "set boxwidth 0.6\nset ylabel 'share of the time (%)'\nset yrange [0:100]\nset xtics rotate by -20\n"
      "plot for [i=2:{}] data using i:xtic(1)\n",
      most.size() + 1);
  return chart;
}

Chart lines(const StudyResults& results, ChartName named, const std::string& x_label,
            const std::string& more = {}) {
  Chart chart{.named = std::move(named)};
  add_blocks(scores_of(results), &chart);
  chart.commands =
      label_command("xlabel", x_label) + "set ylabel 'image IoU (mean)'\n" + more +
      "plot for [i=0:last] data index i using 1:2 with linespoints pt 7 lw 2 dt i/8+1 lc i%8+1 title "
      "columnheader(1)\n";
  return chart;
}

// The mean, the 10th percentile and the least; x is a number, or a list of names that no line joins.
Chart spread(const StudyResults& results, const StabilityAxis& axis) {
  Chart chart{.named = {axis.file, axis.title}};
  add_blocks(scores_of(results), &chart);
  const bool in_order = !axis.x_label.empty();
  const char* x = in_order ? "1" : "($1+0.15*i)";
  const char* style = in_order ? "linespoints" : "points";
  chart.commands =
      label_command("xlabel", axis.x_label) +
      "set ylabel 'image IoU (all scenes and draws)'\nset yrange [-0.03:1.03]\n" + axis.gnuplot +
      fmt::format(
          "plot for [i=0:last] data index i using {0}:2 with {1} pt 7 lw 2 lc i+1 title "
          "columnheader(1).': mean', \\\n"
          "     for [i=0:last] data index i using {0}:4 with {1} pt 8 lw 1.5 dt 2 lc i+1 title '10 %', \\\n"
          "     for [i=0:last] data index i using {0}:3 with {1} pt 1 lw 1 dt 3 lc i+1 title 'least'\n",
          x, style);
  return chart;
}

Chart bars(const StudyResults& results, ChartName named) {
  Chart chart{.named = std::move(named)};
  std::vector<SettingScore> scores = scores_of(results);
  for (SettingScore& s : scores) s.label = s.series;
  add_block(chart.named.name, scores, &chart);
  chart.commands =
      "set style fill solid 0.7 border -1\nset boxwidth 0.6\nset ylabel 'image IoU (mean)'\n"
      "set yrange [0:1.08]\nset xtics rotate by -35\nset rmargin 12\nunset key\n"
      "plot data using 0:2:xtic(7) with boxes lc rgb '#3b7dd8', \\\n"
      "     data using 0:2:(sprintf('%.3f', $2)) with labels offset 0,0.7\n";
  return chart;
}

// One chart a series of the experiment.
std::vector<Chart> needed(const StudyResults& results) {
  std::vector<Chart> charts;
  for (const auto& [series, name] : {std::pair{"views", "needed_views"},
                                     {"width (px)", "needed_width"},
                                     {"neighbours", "needed_neighbours"}}) {
    StudyResults some;
    std::ranges::copy_if(results, std::back_inserter(some),
                         [&, wanted = series](const nlohmann::json& r) { return r.at("series") == wanted; });
    if (!some.empty())
      charts.push_back(lines(some, {name, fmt::format("No more than needed: {}", series)}, series));
  }
  return charts;
}

std::vector<Chart> all_charts(const StudyResults& results) {
  std::vector<Chart> charts;
  const auto add = [&](const std::string& experiment, const auto& make) {
    const StudyResults some = of_experiment(results, experiment);
    if (!some.empty()) charts.push_back(make(some));
  };
  add("trade-off", trade_off);
  add("trade-off", stages);
  add("views", [](const StudyResults& some) {
    return lines(some, {"views", "True masks in all views: how many it takes"}, "views beside the first",
                 "set logscale x 2\n");
  });
  add("energy terms", [](const StudyResults& some) {
    return bars(some, {"energy_terms", "Terms of the energy left out, true masks of 7 views"});
  });
  for (const StabilityAxis& axis : stability_axes())
    add(axis.experiment, [&](const StudyResults& some) { return spread(some, axis); });
  std::ranges::move(needed(of_experiment(results, "needed")), std::back_inserter(charts));
  return charts;
}

}  // namespace

std::vector<ChartName> draw_study_charts(const StudyResults& results, const std::filesystem::path& folder) {
  std::vector<ChartName> drawn;
  std::filesystem::create_directories(folder);
  for (const Chart& chart : all_charts(results)) {
    draw_chart(chart, folder);
    drawn.push_back(chart.named);
  }
  return drawn;
}

}  // namespace splatcut
