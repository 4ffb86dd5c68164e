// splatcut-lab fit: weights of the window's cut from scenes with truth, and what they are worth on a scene
// left out.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/console.h"
#include "app/lab/any_view.h"
#include "app/lab/eval_suite.h"
#include "app/lab/fit.h"
#include "app/lab/lab_commands.h"
#include "app/output_folder.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace splatcut {

namespace {

struct FitArguments {
  std::vector<std::filesystem::path> suites;
  std::filesystem::path output;
  std::string preset = "default";
  std::vector<std::string> only;
  int clicks = 5, starts = 2;
  FitOptions options;
  bool overwrite = false;
};

// What the window's cut takes as numbers today.
struct CutWeights {
  float smoothness = 0;

  std::vector<Weight> table() { return {{"smoothness", &smoothness, 0, 500}}; }
};

// A scene with its sessions' starts, ready to be cut again and again.
struct FittedScene {
  std::unique_ptr<LoadedCase> loaded;
  std::unique_ptr<KeptViews> kept;
  std::shared_ptr<WindowCut> cut;
  AnyViewWorld world;
  std::vector<AnyViewStart> starts;

  FittedScene(std::unique_ptr<LoadedCase> scene, const FitArguments& args, const Job& job)
      : loaded(std::move(scene)), kept(std::make_unique<KeptViews>(*loaded->test.cloud)) {
    EvaluationCase& test = loaded->test;
    test.kept_views = kept.get();
    cut = std::make_shared<WindowCut>(test, args.preset, job);
    world = window_world(test, truth_views(test), cut);
    starts = any_view_starts(test, world.views);
    if (std::ssize(starts) > args.starts) starts.resize(static_cast<std::size_t>(args.starts));
  }

  // Mean over the starts and over 1, 2, ... clicks of the image IoU.
  double score(const CutWeights& weights, int clicks, const Job& job) const {
    cut->set_smoothness(weights.smoothness);
    double sum = 0;
    for (const AnyViewStart& start : starts) {
      const std::vector<double> iou = any_view_session(world, start, clicks, {}, job).iou_after;
      sum += std::accumulate(iou.begin(), iou.end(), 0.0) / clicks;
    }
    return sum / static_cast<double>(starts.size());
  }
};

void stop_if_fit_cancelled(const Job& job) {
  if (job.cancelled()) throw Error("splatcut-lab fit", "cancelled, nothing was written");
}

std::vector<FittedScene> load_all(const FitArguments& args, const CommonOptions& common, const Job& job) {
  PrepareOptions prepare = prepare_options(preset(args.preset));
  prepare.cache = prepared_cache(common);
  std::vector<FittedScene> scenes;
  for (const std::filesystem::path& suite : args.suites)
    for (const nlohmann::json& entry : read_suite(suite)) {
      if (!args.only.empty() && std::ranges::find(args.only, entry.value("name", "")) == args.only.end())
        continue;
      auto loaded = load_case(entry, suite.parent_path(), prepare, job);
      stop_if_fit_cancelled(job);
      scenes.emplace_back(std::move(loaded), args, Job{job.stop, {}});
    }
  if (scenes.empty()) throw Error("splatcut-lab fit", "no scene of the suites is left to fit to");
  return scenes;
}

nlohmann::json values_json(const std::vector<Weight>& weights, const WeightValues& values) {
  nlohmann::json j;
  for (std::size_t i = 0; i < weights.size(); ++i) j[weights[i].name] = values[i];
  return j;
}

nlohmann::json result_json(const FitArguments& args, const std::vector<FittedScene>& scenes,
                           const std::vector<Weight>& weights, const Fitter& fitter,
                           const LeaveOneOut& table) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    nlohmann::json row = {
        {"name", scenes[i].loaded->test.name}, {"shipped", table.shipped[i]}, {"fitted_with", table.with[i]}};
    row["fitted_without"] =
        table.without.empty() ? nlohmann::json(nullptr) : nlohmann::json(table.without[i]);
    if (!table.others.empty()) row["values_without"] = values_json(weights, table.others[i].values);
    rows.push_back(std::move(row));
  }
  return {{"preset", args.preset},
          {"seed", args.options.seed},
          {"clicks", args.clicks},
          {"starts", args.starts},
          {"rounds", args.options.rounds},
          {"scored", fitter.scored()},
          {"shipped", values_json(weights, fitter.shipped())},
          {"fitted", values_json(weights, table.all.values)},
          {"scenes", rows}};
}

double mean_of(const std::vector<double>& values) {
  return values.empty()
             ? 0
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void print_table(const std::vector<FittedScene>& scenes, const std::vector<Weight>& weights,
                 const Fitter& fitter, const LeaveOneOut& table) {
  fmt::print("{:<16} {:>8} {:>12} {:>15}\n", "scene", "shipped", "fitted with", "fitted without");
  const auto row = [&](const std::string& name, double shipped, double with, const std::string& without) {
    fmt::print("{:<16} {:>8.3f} {:>12.3f} {:>15}\n", name, shipped, with, without);
  };
  for (std::size_t i = 0; i < scenes.size(); ++i)
    row(scenes[i].loaded->test.name, table.shipped[i], table.with[i],
        table.without.empty() ? "-" : fmt::format("{:.3f}", table.without[i]));
  row("mean", mean_of(table.shipped), mean_of(table.with),
      table.without.empty() ? "-" : fmt::format("{:.3f}", mean_of(table.without)));
  for (std::size_t i = 0; i < weights.size(); ++i)
    fmt::print("{}: {:g} as shipped, {:g} fitted\n", weights[i].name, fitter.shipped()[i],
               table.all.values[i]);
}

void run_fit(const FitArguments& args, const CommonOptions& common) {
  const Job job = console_job(common.quiet);
  OutputFolder folder(args.output, args.overwrite);
  const std::vector<FittedScene> scenes = load_all(args, common, job);
  CutWeights weights{preset(args.preset).cut.energy.lambda};
  std::size_t scored = 0;
  Fitter fitter(weights.table(), scenes.size(), [&](std::size_t scene) {
    job.progress(fmt::format("score {}", ++scored), 0);
    return scenes[scene].score(weights, args.clicks, Job{job.stop, {}});
  });
  const LeaveOneOut table = leave_one_out(&fitter, scenes.size(), args.options, job);
  stop_if_fit_cancelled(job);
  write_text_file(folder.file("fit.json"),
                  result_json(args, scenes, weights.table(), fitter, table).dump(1) + "\n");
  folder.commit();
  end_progress();
  print_table(scenes, weights.table(), fitter, table);
}

}  // namespace

void add_fit_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<FitArguments>();
  CLI::App& command = *program.add_subcommand(
      "fit", "Fit the weights of the cut to scenes with truth, and score each scene without it");
  command.footer(
      "Score of a scene: mean image IoU over all views with truth, over its starts and over 1, 2, ... clicks "
      "of the "
      "any-view robot.\nAll scenes stay in memory.");
  command.add_option("suites", args->suites, "suite.json files")->required()->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder for fit.json")->required();
  command.add_option("--preset", args->preset, "fast, default, best, paper or paper-code");
  command.add_option("--only", args->only, "Scenes of the suites, by name");
  command.add_option("--robot-clicks", args->clicks, "Clicks a session")->check(CLI::Range(1, 50));
  command.add_option("--starts", args->starts, "The first so many starts of each scene")
      ->check(CLI::Range(1, 1000));
  command.add_option("--rounds", args->options.rounds, "Most rounds of the search")
      ->check(CLI::Range(0, 1000));
  command.add_option("--seed", args->options.seed, "Draws the order in which weights are tried");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common] { run_fit(*args, common); });
}

}  // namespace splatcut
