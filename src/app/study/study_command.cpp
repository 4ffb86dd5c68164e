// splatcut study: speed against accuracy, stability, and how little is enough, as measurements, charts and one page.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <thread>

#include "app/commands.h"
#include "app/console.h"
#include "app/still_life_files.h"
#include "app/study/study_charts.h"
#include "app/study/study_page.h"
#include "app/study/study_plan.h"
#include "app/study/study_runner.h"
#include "app/study/study_store.h"
#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/png_file.h"

namespace splatcut {

namespace {

struct StudyArguments {
  std::vector<std::filesystem::path> suites;
  std::filesystem::path output;
  std::vector<std::string> only;
  int draws = 20;
  std::size_t gaussians = 80000;
  bool quick = false, no_charts = false;
};

struct StudyScene {
  nlohmann::json entry;
  std::filesystem::path folder;
  std::string name;  // of the suite's folder and the entry
};

struct Variant {
  const char* name;
  StillLifeOptions options;
};

// Still lifes with what makes scenes hard, where the user brings none.
std::vector<std::filesystem::path> generated_suites(const StudyArguments& args, const Job& job) {
  std::vector<Variant> variants = {{"plain", {}},
                                   {"twins in contact", {.twins = true, .contact = true}},
                                   {"thin", {.thin_width_scale = 0.6f}},
                                   {"occluded", {.occluder = true}},
                                   {"low contrast", {.low_contrast = true}},
                                   {"straddling", {.straddling = true}},
                                   {"floaters", {.seed = 4, .floaters = true, .unseen_interior = true}}};
  if (args.quick) variants.resize(2);
  std::vector<std::filesystem::path> suites;
  for (Variant& variant : variants) {
    const std::filesystem::path place = args.output / "scenes" / variant.name;
    suites.push_back(place / "suite.json");
    if (std::filesystem::exists(suites.back())) continue;
    std::filesystem::create_directories(place.parent_path());
    variant.options.gaussians = args.gaussians;
    OutputFolder folder(place, true);
    const LabelledScene made = make_still_life(variant.options);
    if (job.cancelled()) throw Error("splatcut study", "cancelled; what is finished is kept, the same command goes on");
    write_still_life(folder, made, "scene", "ply");
    folder.commit();
  }
  return suites;
}

std::vector<StudyScene> scenes_of(const std::vector<std::filesystem::path>& suites, bool generated, bool quick) {
  std::vector<StudyScene> scenes;
  for (const auto& suite : suites) {
    const std::vector<nlohmann::json> entries = read_suite(suite);
    for (std::size_t i = 0; i < (quick ? std::min<std::size_t>(2, entries.size()) : entries.size()); ++i) {
      const std::string name = entries[i].value("name", "?");
      scenes.push_back({entries[i], suite.parent_path(), generated ? suite.parent_path().filename().string() + ", " + name : name});
    }
  }
  return scenes;
}

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string cpu = "unknown processor";
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      cpu = line.substr(line.find(':') + 2);
      break;
    }
  return fmt::format("splatcut {}, {} threads of {}", SPLATCUT_VERSION, std::thread::hardware_concurrency(), cpu);
}

// The settings decide, and the version: results of another program are not this one's.
std::string key_of(const StudyCell& cell, const StudyScene& scene) { return SPLATCUT_VERSION " " + scene.name + " " + to_json(cell).dump(); }

// Every cell on every scene that is not measured yet; scene by scene, each is loaded once.
void measure(const StudyArguments& args, const std::vector<StudyScene>& scenes, const std::vector<StudyCell>& cells, const PreparedCache& cache, const Job& job,
             StudyStore* store) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::size_t all = scenes.size() * cells.size();
  std::size_t done = 0, fresh = 0;
  for (const StudyScene& scene : scenes) {
    StudyRunner runner(scene.entry, scene.folder, cache);
    for (const StudyCell& cell : cells) {
      ++done;
      const std::string key = key_of(cell, scene);
      if (store->holds(key)) continue;
      const double minutes = std::chrono::duration<double>(Clock::now() - start).count() / 60;
      const double left = fresh ? minutes / static_cast<double>(fresh) * static_cast<double>(all - done) : 0;
      job.progress(fresh ? fmt::format("{:.0f} min left", left) : std::string("study"), static_cast<double>(done) / static_cast<double>(all));
      nlohmann::json result = runner.run(cell, {job.stop, {}});
      if (job.cancelled()) throw Error("splatcut study", "cancelled; what is finished is kept in " + args.output.string() + ", the same command goes on");
      ++fresh;
      if (result.is_null()) continue;
      result["scene"] = scene.name;
      store->add(key, std::move(result));
    }
  }
}

// Pictures of the lowest IoU with the shipped settings: what the user would have met.
std::vector<WorstCase> worst_cases(const StudyArguments& args, const std::vector<StudyScene>& scenes, const std::vector<StudyCell>& cells, const PreparedCache& cache,
                                   const StudyResults& results, const Job& job) {
  StudyResults jitter = of_experiment(results, "click jitter");
  std::ranges::stable_sort(jitter, {}, [](const nlohmann::json& r) { return r.at("image_iou").get<double>(); });
  constexpr std::size_t kMost = 6;
  std::vector<WorstCase> worst;
  for (std::size_t i = 0; i < std::min(kMost, jitter.size()); ++i) {
    const std::string name = jitter[i].at("scene"), key = jitter[i].at("key");
    const auto scene = std::ranges::find(scenes, name, &StudyScene::name);
    if (scene == scenes.end()) continue;
    const auto cell = std::ranges::find_if(cells, [&](const StudyCell& c) { return key_of(c, *scene) == key; });
    if (cell == cells.end()) continue;
    const std::filesystem::path png = args.output / fmt::format("worst_{}.png", i + 1);
    write_png(png, StudyRunner(scene->entry, scene->folder, cache).picture(*cell, {job.stop, {}}));
    worst.push_back({fmt::format("{}: {}, draw {}: image IoU {:.3f}", name, cell->series, cell->draw, jitter[i].at("image_iou").get<double>()), png});
  }
  return worst;
}

void run_study(const StudyArguments& args, const CommonOptions& common) {
  const Job job = console_job(common.quiet);
  std::error_code failure;
  std::filesystem::create_directories(args.output, failure);
  if (failure) throw Error(args.output.string(), "cannot be created (" + failure.message() + ")");
  const bool generated = args.suites.empty();
  const std::vector<StudyScene> scenes = scenes_of(generated ? generated_suites(args, job) : args.suites, generated, args.quick);
  std::vector<StudyCell> cells = study_plan(args.quick ? std::min(args.draws, 3) : args.draws, args.quick);
  if (!args.only.empty()) std::erase_if(cells, [&](const StudyCell& c) { return std::ranges::find(args.only, c.experiment) == args.only.end(); });
  if (cells.empty()) throw Error("--only", "names no experiment of the study");
  const PreparedCache cache = prepared_cache(common);
  StudyStore store(args.output / "cells.jsonl");
  measure(args, scenes, cells, cache, job, &store);
  end_progress();
  if (store.results().empty()) throw Error("splatcut study", "none of the scenes has the truth that is asked for");
  write_text_file(args.output / "results.csv", study_csv(store.results()));
  write_text_file(args.output / "results.json", nlohmann::json{{"machine", machine()}, {"results", store.results()}}.dump(1) + "\n");
  if (args.no_charts) return;
  const std::vector<StudyChart> charts = draw_study_charts(store.results(), args.output / "charts");
  const std::vector<WorstCase> worst = worst_cases(args, scenes, cells, cache, store.results(), job);
  write_text_file(args.output / "index.html", study_page(store.results(), charts, args.output / "charts", worst, machine()));
  if (!common.quiet) fmt::print("{}: {} measurements in results.csv, {} charts, index.html\n", args.output.string(), store.results().size(), charts.size());
}

}  // namespace

void add_study_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<StudyArguments>();
  CLI::App& command = *program.add_subcommand("study", "Chart speed against accuracy, stability, and how little is enough; goes on where it was stopped");
  command.footer("Example: splatcut study suite.json -o study    (hours; --quick: minutes)");
  command.add_option("suites", args->suites, "suite.json files; none: still lifes made for it")->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder for measurements, charts and index.html; measurements in it are kept and gone on with")->required();
  command.add_option("--only", args->only, "Experiments, by name as in results.csv");
  command.add_option("--draws", args->draws, "Times that every object is clicked anew by an unsteady hand")->check(CLI::Range(1, 1000));
  command.add_option("--gaussians", args->gaussians, "Of each still life")->check(CLI::Range(std::size_t{1000}, std::size_t{10000000}));
  command.add_flag("--quick", args->quick, "Few cells of each experiment");
  command.add_flag("--no-charts", args->no_charts, "Measurements only");
  command.callback([args, &common] { run_study(*args, common); });
}

}  // namespace splatcut
