#include "app/study/study_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace splatcut {

namespace {

using Points = std::vector<std::pair<double, double>>;

std::vector<std::string> series_of(const std::vector<SettingScore>& scores) {
  std::vector<std::string> names;
  for (const SettingScore& s : scores)
    if (std::ranges::find(names, s.series) == names.end()) names.push_back(s.series);
  return names;
}

// A named block of points, sorted by x.
std::string block(const std::string& name, Points points) {
  std::ranges::sort(points);
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& [x, y] : points) text += fmt::format("{} {}\n", x, y);
  return text + "EOD\n";
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", \\\n     ") + part;
  return text + "\n";
}

Points points_of(const std::vector<SettingScore>& scores, const std::string& series,
                 double SettingScore::*y) {
  Points points;
  for (const SettingScore& s : scores)
    if (s.series == series) points.emplace_back(s.x, s.*y);
  return points;
}

}  // namespace

// In single quotes an apostrophe is written twice.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

Drawing draw_trade_off(const StudyResults& results) {
  Drawing d{{"trade_off", "Speed against accuracy"}, {}, {}, 1080, 680};
  const std::vector<SettingScore> scores = scores_of(results);
  std::vector<std::string> plots;
  Points front;
  for (const SettingScore& s : pareto_front(scores)) front.emplace_back(s.ms / 1000, s.iou);
  double slowest = 0;
  for (const SettingScore& s : scores) slowest = std::max(slowest, s.ms / 1000);
  if (!front.empty()) front.emplace_back(slowest, front.back().second);  // nothing slower is better
  d.data += block("front", front);
  plots.push_back("$front with steps lw 2 lc rgb '#222222' title 'Pareto front'");
  // Colour: where the first mask comes from; shape: the energy.
  const std::map<std::string, std::string> colours = {
      {"parts", "#1b7837"}, {"grabcut", "#d95f02"}, {"pixelcut", "#5e3c99"}};
  const std::map<std::string, int> shapes = {
      {"ours", 7}, {"threshold", 6}, {"paper's energy", 9}, {"its code's energy", 11}};
  int n = 0;
  for (const std::string& series : series_of(scores)) {
    if (series == "preset") continue;
    Points points;
    for (const SettingScore& s : scores)
      if (s.series == series) points.emplace_back(s.ms / 1000, s.iou);
    d.data += block(fmt::format("s{}", n), points);
    const std::size_t semicolon = series.find("; ");
    const bool grid = semicolon != std::string::npos && shapes.contains(series.substr(semicolon + 2)) &&
                      colours.contains(series.substr(0, semicolon));
    plots.push_back(fmt::format("$s{} with points pt {} ps {} lc rgb '{}' title {}", n,
                                grid                      ? shapes.at(series.substr(semicolon + 2))
                                : series == "parts alone" ? 5
                                                          : 13,
                                grid ? 1.1 : 1.7,
                                grid                      ? colours.at(series.substr(0, semicolon))
                                : series == "parts alone" ? "#1b7837"
                                                          : "#000000",
                                quoted(series)));
    ++n;
  }
  // Names above, or below what is worse than the next quicker one, so that neighbours' do not meet.
  std::vector<SettingScore> by_time = scores;
  std::erase_if(by_time, [](const SettingScore& p) { return p.series != "preset"; });
  std::ranges::sort(by_time, {}, &SettingScore::ms);
  for (std::size_t i = 0; i < by_time.size(); ++i) {
    const SettingScore& p = by_time[i];
    d.data += fmt::format("$preset{} << EOD\n{} {} \"{}\"\nEOD\n", i, p.ms / 1000, p.iou, p.label);
    plots.push_back(fmt::format("$preset{} with points pt 3 ps 2 lw 2 lc rgb '#c00000' {}", i,
                                i == 0 ? "title 'presets'" : "notitle"));
    const bool below = i > 0 && by_time[i - 1].iou > p.iou;
    plots.push_back(fmt::format("$preset{} using 1:2:3 with labels offset 0,{} tc rgb '#c00000' notitle", i,
                                below ? -1 : 1));
  }
  d.body =
      "set logscale x\nset xlabel 'seconds from strokes to labels (median over the scenes)'\nset ylabel "
      "'image IoU (mean over the scenes)'\n"
      "set key outside right top\nset yrange [*:1]\nset offsets graph 0.05, graph 0.05, graph 0.06, graph "
      "0.06\nplot " +
      joined(plots);
  return d;
}

Drawing draw_stages(const StudyResults& results) {
  Drawing d{{"stages", "Where the time goes"}, {}, {}, 980, 560};
  std::vector<SettingScore> scores = scores_of(results);
  std::erase_if(scores, [](const SettingScore& s) {
    return s.series != "preset" && s.series != "usual pipeline" && s.series != "parts alone";
  });
  std::map<std::string, double> most;  // share of any bar: what never shows has no place in the key
  const auto sum_of = [](const SettingScore& s) {
    double sum = 0;
    for (const auto& [stage, ms] : s.stages) sum += ms;
    return std::max(sum, 1e-6);
  };
  for (const SettingScore& s : scores)
    for (const auto& [stage, ms] : s.stages) most[stage] = std::max(most[stage], ms / sum_of(s));
  std::erase_if(most, [](const auto& stage) { return stage.second < 0.01; });
  d.data = "$bars << EOD\nname";
  for (const auto& [name, share] : most) d.data += fmt::format(" \"{}\"", name);
  std::set<std::string> seen;
  int bars = 0;
  for (const SettingScore& s : scores) {
    const std::string name = s.series == "preset" ? s.label : s.series;
    if (!seen.insert(name).second) continue;  // one of each
    d.data += fmt::format("\n\"{}\\n{:.0f} ms\"", name, sum_of(s));
    for (const auto& [stage, share] : most)
      d.data += fmt::format(" {}", s.stages.contains(stage) ? 100 * s.stages.at(stage) / sum_of(s) : 0.0);
    ++bars;
  }
  d.data += "\nEOD\n";
  d.body =
      "set bmargin 5\nset style data histograms\nset style histogram rowstacked\nset style fill solid 0.8 "
      "border -1\nset boxwidth 0.6\nset ylabel 'share of the time (%)'\n"
      "set yrange [0:100]\nset key outside right top\n" +
      fmt::format("set xrange [-0.6:{}.6]\nplot for [i=2:{}] $bars using i:xtic(1) title columnhead(i)\n",
                  bars - 1, most.size() + 1);
  return d;
}

Drawing draw_lines(const StudyResults& results, StudyChart chart, const std::string& x_label,
                   const std::string& more) {
  Drawing d{std::move(chart), {}, {}};
  const std::vector<SettingScore> scores = scores_of(results);
  std::vector<std::string> plots;
  int n = 0;
  for (const std::string& series : series_of(scores)) {
    d.data += block(fmt::format("m{}", n), points_of(scores, series, &SettingScore::iou));
    plots.push_back(fmt::format("$m{} with linespoints pt {} lw 2 dt {} lc {} title {}", n, n < 8 ? 7 : 4,
                                n / 8 + 1, n % 8 + 1, quoted(series)));
    ++n;
  }
  d.body = "set xlabel " + quoted(x_label) + "\nset ylabel 'image IoU (mean)'\nset key outside right top\n" +
           more + "plot " + joined(plots);
  return d;
}

Drawing draw_bands(const StudyResults& results, const StabilityAxis& axis) {
  Drawing d{{axis.file, axis.title}, {}, {}};
  const std::vector<SettingScore> scores = scores_of(results);
  const bool in_order = !axis.x_label.empty();  // otherwise x is a list of names, and no line joins them
  std::vector<std::string> bands, lines;
  int n = 0;
  for (const std::string& series : series_of(scores)) {
    std::vector<SettingScore> own;
    std::ranges::copy_if(scores, std::back_inserter(own),
                         [&](const SettingScore& s) { return s.series == series; });
    std::ranges::sort(own, {}, &SettingScore::x);
    d.data += fmt::format("$b{} << EOD\n", n);
    for (const SettingScore& s : own)
      d.data += fmt::format("{} {} {} {} {}\n", s.x, s.p10, s.median, s.p90, s.least);
    d.data += "EOD\n";
    if (in_order)
      bands.push_back(
          fmt::format("$b{} using 1:2:4 with filledcurves lc {} fs transparent solid 0.18 noborder title "
                      "'10th to 90th percentile'",
                      n, n + 1));
    const std::string x = in_order ? "1" : fmt::format("($1+{})", 0.15 * n),
                      line = in_order ? "linespoints" : "points";
    bands.push_back(fmt::format("$b{} using {}:3:2:4 with yerrorbars pt 0 lw 1.5 lc {} {}", n, x, n + 1,
                                in_order ? "notitle" : "title '10th to 90th percentile'"));
    lines.push_back(fmt::format("$b{} using {}:3 with {} pt 7 lw 2 lc {} title {}", n, x, line, n + 1,
                                quoted("median, " + series)));
    lines.push_back(fmt::format("$b{} using {}:5 with {} pt 1 {} lw 1.5 lc {} title 'least'", n, x, line,
                                in_order ? "dt 3" : "", n + 1));
    ++n;
  }
  bands.insert(bands.end(), lines.begin(), lines.end());
  d.body =
      (axis.x_label.empty() ? std::string() : "set xlabel " + quoted(axis.x_label) + "\n") +
      "set ylabel 'image IoU (all scenes and draws)'\nset yrange [-0.03:1.03]\nset key outside right top\n" +
      axis.gnuplot + "plot " + joined(bands);
  return d;
}

Drawing draw_bad_masks(const StudyResults& results, const StabilityAxis& axis) {
  Drawing d{{axis.file, axis.title}, {}, {}};
  const std::vector<SettingScore> scores = scores_of(results);
  std::map<std::string, std::string> strength;  // of each kind, the first: one line a kind
  std::vector<std::string> plots;
  int n = 0;
  for (const std::string& series : series_of(scores)) {
    const std::string kind = series.substr(0, series.find_first_of(" ,")),
                      px = series.substr(0, series.find(','));
    if (strength.try_emplace(kind, px).first->second != px) continue;
    const bool threshold = series.ends_with("threshold");
    d.data += block(fmt::format("m{}", n), points_of(scores, series, &SettingScore::p10));
    plots.push_back(fmt::format("$m{} with linespoints pt {} lw 2 dt {} lc {} title {}", n, threshold ? 6 : 7,
                                threshold ? 2 : 1, n / 2 + 1, quoted(series)));
    ++n;
  }
  d.body = "set xlabel " + quoted(axis.x_label) +
           "\nset ylabel 'image IoU (10th percentile of scenes and draws)'\nset yrange [-0.03:1.03]\nset key "
           "outside right top\n" +
           "plot " + joined(plots);
  return d;
}

Drawing draw_bars(const StudyResults& results, StudyChart chart) {
  Drawing d{std::move(chart), {}, {}};
  d.data = "$bars << EOD\n";
  for (const SettingScore& s : scores_of(results)) d.data += fmt::format("\"{}\" {}\n", s.series, s.iou);
  d.data += "EOD\n";
  d.body =
      "set style fill solid 0.7 border -1\nset boxwidth 0.6\nset ylabel 'image IoU (mean)'\nset yrange "
      "[0:1.08]\nset xtics rotate by -35\nset rmargin 12\nunset key\n"
      "plot $bars using 0:2:xtic(1) with boxes lc rgb '#3b7dd8', $bars using 0:2:(sprintf('%.3f', $2)) with "
      "labels offset 0,0.7\n";
  return d;
}

}  // namespace splatcut
