#include "app/study/study_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/run_program.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace splatcut {

namespace {

struct Drawing {
  StudyChart chart;
  std::string data, body;  // gnuplot
  int width_px = 900, height_px = 560;
};

std::vector<std::string> series_of(const std::vector<SettingScore>& scores) {
  std::vector<std::string> names;
  for (const SettingScore& s : scores)
    if (std::ranges::find(names, s.series) == names.end()) names.push_back(s.series);
  return names;
}

// A named block of points, sorted by x.
std::string block(const std::string& name, std::vector<std::pair<double, double>> points) {
  std::ranges::sort(points);
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& [x, y] : points) text += fmt::format("{} {}\n", x, y);
  return text + "EOD\n";
}

// A gnuplot string: in single quotes an apostrophe is written twice.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", \\\n     ") + part;
  return text + "\n";
}

Drawing trade_off(const StudyResults& results) {
  Drawing d{{"trade_off", "Speed against accuracy"}, {}, {}, 980, 640};
  const std::vector<SettingScore> scores = scores_of(results);
  std::vector<std::string> plots;
  std::vector<std::pair<double, double>> front;
  for (const SettingScore& s : pareto_front(scores)) front.emplace_back(s.ms / 1000, s.iou);
  d.data += block("front", front);
  plots.push_back("$front with steps lw 2 lc rgb '#222222' title 'Pareto front'");
  int n = 0;
  for (const std::string& series : series_of(scores)) {
    if (series == "preset") continue;
    std::vector<std::pair<double, double>> points;
    for (const SettingScore& s : scores)
      if (s.series == series) points.emplace_back(s.ms / 1000, s.iou);
    d.data += block(fmt::format("s{}", n), points);
    plots.push_back(fmt::format("$s{} with points pt {} ps 1.2 lc {} title {}", n, 5 + n % 10, n + 1, quoted(series)));
    ++n;
  }
  std::string presets = "$presets << EOD\n";
  for (const SettingScore& s : scores)
    if (series_of({s}).front() == "preset") presets += fmt::format("{} {} \"{}\"\n", s.ms / 1000, s.iou, s.label);
  d.data += presets + "EOD\n";
  plots.push_back("$presets with points pt 3 ps 1.8 lw 2 lc rgb '#c00000' title 'presets'");
  plots.push_back("$presets using 1:2:3 with labels offset 0,1 tc rgb '#c00000' notitle");
  d.body = "set logscale x\nset xlabel 'seconds from strokes to labels (median over the scenes)'\nset ylabel 'image IoU (mean over the scenes)'\n"
           "set key outside right top\nset yrange [*:1]\nset offsets graph 0.05, graph 0.05, graph 0.04, 0\nplot " + joined(plots);
  return d;
}

Drawing stages(const StudyResults& results) {
  Drawing d{{"stages", "Where the time goes"}, {}, {}, 900, 520};
  std::vector<SettingScore> scores = scores_of(results);
  std::erase_if(scores, [](const SettingScore& s) { return s.series != "preset" && s.series != "usual pipeline" && s.series != "parts alone"; });
  std::set<std::string> names;
  for (const SettingScore& s : scores)
    for (const auto& [stage, ms] : s.stages) names.insert(stage);
  d.data = "$bars << EOD\nname";
  for (const std::string& name : names) d.data += fmt::format(" \"{}\"", name);
  for (const SettingScore& s : scores) {
    d.data += fmt::format("\n\"{}\"", s.series == "preset" ? s.label : s.series);
    for (const std::string& name : names) d.data += fmt::format(" {}", s.stages.contains(name) ? s.stages.at(name) : 0.0);
  }
  d.data += "\nEOD\n";
  d.body = "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.8 border -1\nset boxwidth 0.6\nset ylabel 'ms (mean over the scenes)'\n"
           "set key outside right top\n" + fmt::format("plot for [i=2:{}] $bars using i:xtic(1) title columnhead(i)\n", names.size() + 1);
  return d;
}

// IoU over x, one line per series: mean, and the least of the scenes dotted.
Drawing lines(const StudyResults& results, StudyChart chart, const std::string& x_label, const std::string& more, bool least = false) {
  Drawing d{std::move(chart), {}, {}, 900, 520};
  const std::vector<SettingScore> scores = scores_of(results);
  std::vector<std::string> plots;
  int n = 0;
  for (const std::string& series : series_of(scores)) {
    std::vector<std::pair<double, double>> mean, low;
    for (const SettingScore& s : scores)
      if (s.series == series) {
        mean.emplace_back(s.x, s.iou);
        low.emplace_back(s.x, s.least_iou);
      }
    d.data += block(fmt::format("m{}", n), mean) + block(fmt::format("l{}", n), low);
    plots.push_back(fmt::format("$m{} with linespoints pt {} lw 2 dt {} lc {} title {}", n, n < 8 ? 7 : 4, n / 8 + 1, n % 8 + 1, quoted(series)));
    if (least) plots.push_back(fmt::format("$l{} with lines dt 3 lw 1.5 lc {} title 'least of the scenes'", n, n % 8 + 1));
    ++n;
  }
  d.body = "set xlabel " + quoted(x_label) + "\nset ylabel 'image IoU'\nset key outside right top\n" + more + "plot " + joined(plots);
  return d;
}

Drawing jitter(const StudyResults& results) {
  Drawing d{{"click_jitter", "The same object, clicked again and again"}, {}, {}, 980, 560};
  const std::vector<Spread> spreads = spreads_of(results);
  d.data = "$box << EOD\n";
  for (std::size_t i = 0; i < spreads.size(); ++i)
    d.data += fmt::format("{} {} {} {} {} {} \"{}, {}\"\n", i, spreads[i].p10, spreads[i].least, spreads[i].most, spreads[i].p90, spreads[i].median,
                          spreads[i].scene, spreads[i].series);
  d.data += "EOD\n";
  d.body = "set boxwidth 0.5\nset style fill solid 0.4\nset ylabel 'image IoU'\nset xtics rotate by -40\nset offsets 0.5, 0.5, 0.02, 0.02\nset rmargin 12\nset key below\n"
           "plot $box using 1:2:3:4:5:xtic(7) with candlesticks title 'least, 10 %, 90 %, most' whiskerbars, "
           "$box using 1:6:6:6:6 with candlesticks lw 2 lc rgb '#c00000' title 'median'\n";
  return d;
}

void draw(const Drawing& drawing, const std::filesystem::path& folder) {
  const auto script_for = [&](const std::string& terminal, const std::string& ending) {
    return fmt::format("set terminal {} size {},{}\nset output {}\nset title {}\nset grid\n{}unset output\nreset\n", terminal, drawing.width_px,
                       drawing.height_px, quoted((folder / (drawing.chart.name + ending)).string()), quoted(drawing.chart.title), drawing.body);
  };
  const std::filesystem::path script = folder / (drawing.chart.name + ".gp");
  write_text_file(script, drawing.data + script_for("svg noenhanced font 'sans,13' background 'white'", ".svg") + script_for("pngcairo noenhanced font 'sans,10'", ".png"));
  const ProgramEnd end = run_program({"gnuplot", script.string()}, {});
  if (end.exit_code != 0)
    throw Error("gnuplot", end.start_error ? "cannot be started" : fmt::format("ended with code {} on {}", end.exit_code, script.string()),
                "Install gnuplot-nox; the measurements are kept, run the same command again");
}

}  // namespace

std::vector<StudyChart> draw_study_charts(const StudyResults& results, const std::filesystem::path& folder) {
  std::vector<StudyChart> charts;
  const auto add = [&](const std::string& experiment, const auto& make) {
    const StudyResults some = of_experiment(results, experiment);
    if (some.empty()) return;
    const Drawing drawing = make(some);
    draw(drawing, folder);
    charts.push_back(drawing.chart);
  };
  const auto add_lines = [&](const std::string& experiment, const std::string& name, const std::string& title, const std::string& x_label,
                             const std::string& more = "", bool least = true) {
    add(experiment, [&](const StudyResults& some) { return lines(some, {name, title}, x_label, more, least); });
  };
  std::filesystem::create_directories(folder);
  add("trade-off", trade_off);
  add("trade-off", stages);
  add_lines("views", "views", "True masks in all views: how many it takes", "views beside the first", "set logscale x 2\n", false);
  add("click jitter", jitter);
  add_lines("bad masks", "bad_masks", "Some of the masks are wrong", "share of the views whose mask is wrong", "", false);
  add_lines("strokes across the border", "long_strokes", "Strokes that run across the border", "length of each stroke (pixels of the reference)");
  add_lines("scene scale", "scene_scale", "The same scene in other units", "scale", "set logscale x\n");
  add_lines("wrong up", "wrong_up", "Up is not up", "tilt (degrees)");
  add_lines("orbit distance", "orbit_distance", "Orbit views nearer and farther", "distance (object sizes)");
  add_lines("step back", "step_back", "The first view nearer and farther", "distance (of the reference)", "set logscale x 2\n");
  const StudyResults needed = of_experiment(results, "needed");
  for (const auto& [series, name] : {std::pair{"views", "needed_views"}, {"width (px)", "needed_width"}, {"neighbours", "needed_neighbours"}}) {
    StudyResults some;
    std::ranges::copy_if(needed, std::back_inserter(some), [&](const nlohmann::json& r) { return r.at("series") == series; });
    for (nlohmann::json& r : some) r["series"] = r.at("scene");
    if (some.empty()) continue;
    const Drawing drawing = lines(some, {name, fmt::format("No more than needed: {}", series)}, series, "", false);
    draw(drawing, folder);
    charts.push_back(drawing.chart);
  }
  return charts;
}

}  // namespace splatcut
