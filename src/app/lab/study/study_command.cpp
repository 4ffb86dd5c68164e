// splatcut-lab study: speed against accuracy, stability, and how little is enough, as measurements, charts
// and one page.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <thread>

#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/version.h"
#include "app/lab/lab_commands.h"
#include "app/lab/study/study_charts.h"
#include "app/lab/study/study_page.h"
#include "app/lab/study/study_plan.h"
#include "app/lab/study/study_runner.h"
#include "app/lab/study/study_scenes.h"
#include "app/lab/study/study_store.h"
#include "core/atomic_file.h"
#include "core/byte_hash.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/png_file.h"

namespace splatcut {

namespace {

struct StudyArguments {
  std::vector<std::filesystem::path> suites;
  std::filesystem::path output;
  std::vector<std::string> only;
  int draws = 20;
  std::optional<std::size_t> gaussians;
  std::size_t cells = 0;
  bool quick = false, no_charts = false;
};

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string cpu = "unknown processor";
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      cpu = line.substr(line.find(':') + 2);
      break;
    }
  return fmt::format("splatcut {}, {} threads of {}", version(), std::thread::hardware_concurrency(), cpu);
}

std::string file_name_of(std::string experiment) {
  std::ranges::replace(experiment, ' ', '_');
  return experiment;
}

std::string key_of(const StudyCell& cell, const StudyScene& scene) {
  return scene.key + " " + json_text(to_json(cell));
}

// Every cell on every scene that is not measured yet; scene by scene, each is loaded once.
void measure_cells(const StudyArguments& args, const std::vector<StudyScene>& scenes,
                   const std::vector<StudyCell>& cells, const PreparedCache& cache, const Job& job,
                   StudyStore* store) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto asked = [](const StudyCell& cell, const StudyScene& scene) {
    return cell.still_life == scene.still_life;
  };
  std::size_t all = 0;
  for (const StudyScene& scene : scenes)
    all += static_cast<std::size_t>(
        std::ranges::count_if(cells, [&](const StudyCell& c) { return asked(c, scene); }));
  std::size_t done = 0, fresh = 0;
  for (const StudyScene& scene : scenes) {
    StudyRunner runner(scene.entry, scene.folder, cache);
    for (const StudyCell& cell : cells) {
      if (!asked(cell, scene)) continue;
      ++done;
      const std::string key = key_of(cell, scene);
      if (store->holds(key)) continue;
      const double minutes = std::chrono::duration<double>(Clock::now() - start).count() / 60;
      const double left = fresh ? minutes / static_cast<double>(fresh) * static_cast<double>(all - done) : 0;
      job.progress(fresh ? fmt::format("{:.0f} min left", left) : std::string("study"),
                   static_cast<double>(done) / static_cast<double>(all));
      nlohmann::json result = runner.run(cell, {job.stop, {}});
      if (job.cancelled())
        throw Error("splatcut-lab study", "cancelled; what is finished is kept in " + args.output.string() +
                                              ", the same command goes on");
      ++fresh;
      if (result.is_null()) continue;
      result["scene"] = scene.name;
      store->add(key, std::move(result));
    }
  }
}

// The first so many settings of each experiment, with all their draws.
void keep_first(std::size_t most, std::vector<StudyCell>* cells) {
  std::map<std::string, std::set<std::string>> kept;
  std::erase_if(*cells, [&](StudyCell cell) {
    cell.draw = 0;
    std::set<std::string>& settings = kept[cell.experiment];
    const std::string setting = json_text(to_json(cell));
    if (settings.contains(setting)) return false;
    if (settings.size() >= most) return true;
    settings.insert(setting);
    return false;
  });
}

std::vector<StudyCell> chosen_cells(const StudyArguments& args) {
  constexpr int kQuickDraws = 3;
  std::vector<StudyCell> cells =
      study_plan(args.quick ? std::min(args.draws, kQuickDraws) : args.draws, args.quick);
  for (const std::string& name : args.only)
    if (std::ranges::find(cells, name, &StudyCell::experiment) == cells.end())
      throw Error("--only " + name, "is no experiment of the study");
  if (!args.only.empty())
    std::erase_if(cells, [&](const StudyCell& c) {
      return std::ranges::find(args.only, c.experiment) == args.only.end();
    });
  if (args.cells > 0) keep_first(args.cells, &cells);
  return cells;
}

std::vector<StudyScene> chosen_scenes(const StudyArguments& args, const std::vector<StudyCell>& cells,
                                      const Job& job) {
  constexpr std::size_t kGaussians = 80000, kQuickGaussians = 30000;
  StudyScenesOptions options{args.suites,
                             {},
                             args.output / "scenes",
                             args.gaussians.value_or(args.quick ? kQuickGaussians : kGaussians),
                             args.quick};
  for (const StudyCell& cell : cells)
    if (!cell.still_life.empty() &&
        std::ranges::find(options.still_lifes, cell.still_life) == options.still_lifes.end())
      options.still_lifes.push_back(cell.still_life);
  return study_scenes(options, job);
}

struct Lowest {
  const StudyScene* scene = nullptr;
  const StudyCell* cell = nullptr;
  nlohmann::json result;
};

// The lowest IoU of each experiment.
std::vector<Lowest> lowest_of(const StudyResults& results, const std::vector<StudyScene>& scenes,
                              const std::vector<StudyCell>& cells) {
  std::vector<Lowest> lowest;
  for (const std::string& experiment : experiments_of(results)) {
    const StudyResults some = of_experiment(results, experiment);
    const auto result = std::ranges::min_element(
        some, {}, [](const nlohmann::json& r) { return r.at("image_iou").get<double>(); });
    for (const StudyScene& scene : scenes)
      for (const StudyCell& cell : cells)
        if (cell.experiment == experiment && cell.still_life == scene.still_life &&
            scene.name == result->at("scene") && key_of(cell, scene) == result->at("key"))
          lowest.push_back({&scene, &cell, *result});
  }
  return lowest;
}

// Their pictures: what the user would have met.
std::vector<WorstCase> worst_cases(const StudyArguments& args, std::vector<Lowest> lowest,
                                   const PreparedCache& cache, const Job& job) {
  std::vector<WorstCase> worst;
  std::ranges::stable_sort(lowest, {}, &Lowest::scene);  // each is loaded once
  std::optional<StudyRunner> runner;
  for (std::size_t i = 0; i < lowest.size(); ++i) {
    const auto& [scene, cell, result] = lowest[i];
    if (i == 0 || lowest[i - 1].scene != scene) runner.emplace(scene->entry, scene->folder, cache);
    job.progress("worst case: " + cell->experiment,
                 static_cast<double>(i) / static_cast<double>(lowest.size()));
    const std::string png = fmt::format("worst_{}.png", file_name_of(cell->experiment));
    const Image<Rgb8> picture = runner->picture(*cell, {job.stop, {}});
    if (job.cancelled())
      throw Error("splatcut-lab study", "cancelled; what is finished is kept in " + args.output.string() +
                                            ", the same command goes on");
    write_png(args.output / png, picture);
    const std::string warned = result.at("warned"),
                      draw = cell->draw ? fmt::format(", draw {}", cell->draw) : "";
    worst.push_back({fmt::format("{}: {}, {}, at {:g}{}: image IoU {:.3f}. Said: {}", cell->experiment,
                                 scene->name, cell->series, cell->x, draw,
                                 result.at("image_iou").get<double>(), warned.empty() ? "nothing" : warned),
                     png});
  }
  end_progress();
  return worst;
}

void run_study(const StudyArguments& args, const CommonOptions& common) {
  refuse_written_inputs(args.output, args.suites);
  const Job job = console_job(common.quiet);
  std::error_code failure;
  std::filesystem::create_directories(args.output, failure);
  if (failure) throw Error(args.output.string(), "cannot be created (" + failure.message() + ")");
  const std::vector<StudyCell> cells = chosen_cells(args);
  const std::vector<StudyScene> scenes = chosen_scenes(args, cells, job);
  const PreparedCache cache = prepared_cache(common);
  StudyStore store(args.output / "cells.jsonl", fmt::format("{:016x}", hash_of_program()));
  if (store.of_others() > 0)
    warn(fmt::format("{}: {} measurements of another program do not count",
                     (args.output / "cells.jsonl").string(), store.of_others()),
         common.quiet);
  measure_cells(args, scenes, cells, cache, job, &store);
  end_progress();
  if (store.results().empty())
    throw Error("splatcut-lab study", "none of the scenes has the truth that is asked for");
  write_text_file(args.output / "results.csv", study_csv(store.results()));
  write_text_file(args.output / "results.json",
                  json_text({{"machine", machine()}, {"results", store.results()}}, 1) + "\n");
  if (args.no_charts) return;
  const std::vector<ChartName> charts = draw_study_charts(store.results(), args.output / "charts");
  const std::vector<WorstCase> worst =
      worst_cases(args, lowest_of(store.results(), scenes, cells), cache, job);
  write_text_file(args.output / "study.md", study_page(store.results(), charts, worst, machine()));
  if (!common.quiet)
    fmt::print("{}: {} measurements in results.csv, {} charts, study.md\n", args.output.string(),
               store.results().size(), charts.size());
}

}  // namespace

void add_study_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<StudyArguments>();
  CLI::App& command = *program.add_subcommand(
      "study",
      "Chart speed against accuracy, stability, and how little is enough; goes on where it was stopped");
  command.footer("Example: splatcut-lab study suite.json -o study    (hours; --quick: minutes)");
  command
      .add_option("suites", args->suites,
                  "suite.json files; none: a still life made for it. What is hard by design is asked of "
                  "still lifes in any case")
      ->check(CLI::ExistingFile);
  command
      .add_option(
          "-o,--output", args->output,
          "Folder for measurements, charts and study.md; measurements in it are kept and gone on with")
      ->required();
  command.add_option("--only", args->only, "Experiments, by name as in results.csv");
  command
      .add_option(
          "--draws", args->draws,
          "Times that every object is clicked anew by an unsteady hand, and all else by chance drawn anew")
      ->check(CLI::Range(1, 1000));
  command.add_option("--gaussians", args->gaussians, "Of each still life (80000; --quick: 30000)")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{10000000}));
  command.add_flag("--quick", args->quick,
                   "Few settings of each experiment, two scenes a suite, three draws");
  command.add_option("--cells", args->cells, "Most settings of each experiment; 0: all");
  command.add_flag("--no-charts", args->no_charts, "Measurements only");
  command.callback([args, &common] { run_study(*args, common); });
}

}  // namespace splatcut
