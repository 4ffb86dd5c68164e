#include "app/study/study_charts.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/run_program.h"
#include "app/study/study_drawings.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace splatcut {

namespace {

void draw(const Drawing& drawing, const std::filesystem::path& folder) {
  const auto script_for = [&](const std::string& terminal, const std::string& ending) {
    return fmt::format(
        "set terminal {} size {},{}\nset output {}\nset title {}\nset grid\n{}unset output\nreset\n",
        terminal, drawing.width_px, drawing.height_px,
        quoted((folder / (drawing.chart.name + ending)).string()), quoted(drawing.chart.title), drawing.body);
  };
  const std::filesystem::path script = folder / (drawing.chart.name + ".gp");
  write_text_file(script, drawing.data +
                              script_for("svg noenhanced font 'sans,13' background 'white'", ".svg") +
                              script_for("pngcairo noenhanced font 'sans,10'", ".png"));
  const ProgramEnd end = run_program({"gnuplot", script.string()}, {});
  if (end.exit_code != 0)
    throw Error("gnuplot",
                end.start_error ? "cannot be started"
                                : fmt::format("ended with code {} on {}", end.exit_code, script.string()),
                "Install gnuplot-nox; the measurements are kept, run the same command again");
}

// One chart a series of the experiment, one line a scene.
void draw_needed(const StudyResults& needed, const std::filesystem::path& folder,
                 std::vector<StudyChart>* charts) {
  for (const auto& [series, name] : {std::pair{"views", "needed_views"},
                                     {"width (px)", "needed_width"},
                                     {"neighbours", "needed_neighbours"}}) {
    StudyResults some;
    std::ranges::copy_if(needed, std::back_inserter(some),
                         [&](const nlohmann::json& r) { return r.at("series") == series; });
    for (nlohmann::json& r : some) r["series"] = r.at("scene");
    if (some.empty()) continue;
    const Drawing drawing =
        draw_lines(some, {name, fmt::format("No more than needed: {}", series)}, series, "");
    draw(drawing, folder);
    charts->push_back(drawing.chart);
  }
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
  std::filesystem::create_directories(folder);
  add("trade-off", draw_trade_off);
  add("trade-off", draw_stages);
  add("views", [](const StudyResults& some) {
    return draw_lines(some, {"views", "True masks in all views: how many it takes"}, "views beside the first",
                      "set logscale x 2\n");
  });
  add("energy terms", [](const StudyResults& some) {
    return draw_bars(some, {"energy_terms", "Terms of the energy left out, true masks of 7 views"});
  });
  for (const StabilityAxis& axis : stability_axes())
    add(axis.experiment, [&](const StudyResults& some) {
      return axis.experiment == "bad masks" ? draw_bad_masks(some, axis) : draw_bands(some, axis);
    });
  draw_needed(of_experiment(results, "needed"), folder, &charts);
  return charts;
}

}  // namespace splatcut
