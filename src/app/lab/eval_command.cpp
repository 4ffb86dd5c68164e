// splatcut-lab eval: the measures of a suite, as a table and as JSON.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/mask_options.h"
#include "app/console/output_folder.h"
#include "app/console/setting_options.h"
#include "app/console/version.h"
#include "app/lab/alone_report.h"
#include "app/lab/any_view_report.h"
#include "app/lab/benchmark_folders.h"
#include "app/lab/eval_suite.h"
#include "app/lab/lab_commands.h"
#include "app/lab/part_model_file.h"
#include "app/lab/published_scores.h"
#include "app/measure/click_draws.h"
#include "core/atomic_file.h"
#include "core/json_file.h"
#include "core/png_file.h"
#include "segment/session/settings_table.h"

namespace splatcut {

namespace {

struct EvalArguments {
  std::filesystem::path suite, nvos, spin_nerf, scenes, output, model;
  std::string preset = "default", masks;
  MaskOptions mask;
  std::vector<std::string> set, only;
  int clicks = 3, draws = 0;
  AnyViewOptions robot;
  bool any_view = false, sheets = false, curve = true, json = false, overwrite = false, clicks_given = false;
  bool robot_asked = false;  // an option that only the any-view robot has
};

nlohmann::json score_json(const SceneScore& s) {
  nlohmann::json j = {{"name", s.name},
                      {"image_iou", s.image_iou},
                      {"accuracy", s.accuracy},
                      {"boundary_iou", s.boundary_iou},
                      {"psnr_db", s.psnr_db},
                      {"ssim", s.ssim},
                      {"mask_iou_after_clicks", s.mask_iou_after_clicks},
                      {"total_ms", s.total_ms},
                      {"ms", nlohmann::json::object()}};
  const auto where_known = [](const auto& v) { return v ? nlohmann::json(*v) : nullptr; };
  j["gaussian_iou"] = where_known(s.gaussian_iou);
  j["image_iou_by_scribbles"] = where_known(s.image_iou_by_scribbles);
  j["noc85"] = where_known(s.noc85);
  j["noc90"] = where_known(s.noc90);
  j["image_iou_after_clicks"] = nlohmann::json::object();
  for (const auto& [n, value] : s.image_iou_after_clicks)
    j["image_iou_after_clicks"][std::to_string(n)] = value;
  for (const StageTime& stage : s.stages) j["ms"][stage.name] = stage.ms;
  if (s.alone) j.update(cutout_json(*s.alone));
  j["doubts"] = s.doubts;
  j["enough"] = {{"views", s.enough.views},
                 {"pixels", s.enough.pixels},
                 {"gaussians", s.nodes_touched},
                 {"why", s.why_enough}};
  return j;
}

// What has no mean: sentences, and sessions of which each scene has its own number.
nlohmann::json without_lists(nlohmann::json score) {
  score.erase("doubts");
  if (score.contains("any_view")) score["any_view"].erase("sessions");
  return score;
}

// The mean over the scenes of each number; scenes that lack one do not count in its mean.
nlohmann::json mean_json(const std::vector<nlohmann::json>& scores) {
  const auto mean_of = [&scores](const nlohmann::json::json_pointer& at) -> nlohmann::json {
    double sum = 0;
    int n = 0;
    for (const auto& s : scores)
      if (s.contains(at) && s.at(at).is_number()) {
        sum += s.at(at).get<double>();
        ++n;
      }
    return n ? nlohmann::json(sum / n) : nullptr;
  };
  // The first score is the mould: a pointer into nothing would make an array of the keys "1", "3", "5".
  nlohmann::json mean = scores.empty() ? nlohmann::json::object() : without_lists(scores.front());
  mean["name"] = "mean";
  if (mean.contains("enough")) mean["enough"].erase("why");
  for (const auto& s : scores) {
    const nlohmann::json flat = without_lists(s).flatten();  // named: items() only refers to it
    for (const auto& [at, value] : flat.items())
      if (value.is_number())
        mean[nlohmann::json::json_pointer(at)] = mean_of(nlohmann::json::json_pointer(at));
  }
  return mean;
}

void print_heads() {
  fmt::print("{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>6} {:>5} {:>5} {:>8}\n",
             "scene", "img IoU", "acc", "bnd IoU", "gau IoU", "PSNR", "SSIM", "1 click", "3", "5",
             "scribbles", "NoC90", "views", "Mpx", "ms");
}

void print_row(const nlohmann::json& s) {
  const auto number = [&s](const char* key, const char* form) {
    return s.contains(key) && s.at(key).is_number() ? fmt::format(fmt::runtime(form), s.at(key).get<double>())
                                                    : std::string("-");
  };
  const auto after = [&s](const char* n) {
    const auto& curve = s.value("image_iou_after_clicks", nlohmann::json::object());
    return curve.contains(n) ? fmt::format("{:.3f}", curve.at(n).get<double>()) : std::string("-");
  };
  const nlohmann::json none, &enough = s.contains("enough") ? s.at("enough") : none;
  const auto looked = [&enough](const char* key, double unit, const char* form) {
    return enough.is_object() ? fmt::format(fmt::runtime(form), enough.at(key).get<double>() / unit)
                              : std::string("-");
  };
  fmt::print("{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>6} {:>5} {:>5} {:>8}\n",
             s.value("name", ""), number("image_iou", "{:.3f}"), number("accuracy", "{:.4f}"),
             number("boundary_iou", "{:.3f}"), number("gaussian_iou", "{:.3f}"), number("psnr_db", "{:.2f}"),
             number("ssim", "{:.4f}"), after("1"), after("3"), after("5"),
             number("image_iou_by_scribbles", "{:.3f}"), number("noc90", "{:.1f}"),
             looked("views", 1, "{:.0f}"), looked("pixels", 1e6, "{:.2f}"), number("total_ms", "{:.0f}"));
}

nlohmann::json draws_json(const ClickDraws& d) {
  return {{"median", d.median},         {"least", d.least},
          {"mean_noc85", d.mean_noc85}, {"mean_noc90", d.mean_noc90},
          {"most_noc90", d.most_noc90}, {"least_from_second_click", d.least_from_second}};
}

// The first mask under an unsteady hand, a row per scene.
void print_draws(const nlohmann::json& result, int draws) {
  fmt::print("\nfirst mask, IoU after 1..{} clicks, median / least of {} draws\n", kRobotClicks, draws);
  std::vector<nlohmann::json> rows = result.at("scenes");
  rows.push_back(result.at("mean"));
  for (const nlohmann::json& s : rows) {
    if (!s.contains("draws")) continue;
    const nlohmann::json& d = s.at("draws");
    fmt::print("{:<16}", s.value("name", ""));
    for (std::size_t k = 0; k < d.at("median").size(); ++k)
      fmt::print(" {:.3f}/{:.3f}", d.at("median")[k].get<double>(), d.at("least")[k].get<double>());
    if (d.contains("mean_noc90"))
      fmt::print("  NoC85 {:.2f} NoC90 {:.2f}, most {}", d.at("mean_noc85").get<double>(),
                 d.at("mean_noc90").get<double>(), d.at("most_noc90").get<double>());
    fmt::print("\n");
  }
}

// --first-mask truth needs the truth of the reference view, --masks truth that of any view.
bool lacks_truth(const EvaluationCase& test, const EvaluationOptions& options) {
  return (options.masks_of_others && std::ranges::count_if(test.truth_masks, counts) < 2) ||
         (options.truth_first_mask && !test.reference_truth) ||
         (options.truth_masks && test.truth_labels.empty());
}

// A scene to measure, loaded when its turn comes.
using Loader = std::function<std::unique_ptr<LoadedCase>(const PrepareOptions&, const Job&)>;

std::vector<Loader> loaders(const EvalArguments& args) {
  std::vector<Loader> all;
  std::vector<std::string> names;
  const auto asked = [&](const std::string& name) {
    names.push_back(name);
    return args.only.empty() || std::ranges::find(args.only, name) != args.only.end();
  };
  if (!args.suite.empty())
    for (const nlohmann::json& entry : read_suite(args.suite))
      if (asked(entry.value("name", "")))
        all.push_back(
            [entry, folder = args.suite.parent_path()](const PrepareOptions& prepare, const Job& job) {
              return load_case(entry, folder, prepare, job);
            });
  std::vector<BenchmarkTask> tasks;
  if (!args.nvos.empty()) tasks = nvos_tasks(args.nvos, args.scenes);
  if (!args.spin_nerf.empty()) tasks = spin_nerf_tasks(args.spin_nerf, args.scenes);
  for (const BenchmarkTask& task : tasks)
    if (asked(task.name))
      all.push_back(
          [task](const PrepareOptions& prepare, const Job& job) { return load_task(task, prepare, job); });
  refuse_unknown("--only", args.only, names);
  return all;
}

bool first_mask_is_truth(const EvalArguments& args) {
  return args.mask.first_mask == "truth" || !args.spin_nerf.empty();
}

EvaluationOptions evaluation_options(const EvalArguments& args) {
  EvaluationOptions options;
  options.settings = preset(args.preset);
  options.clicks = args.clicks;
  options.truth_first_mask = first_mask_is_truth(args);
  options.truth_masks = args.masks == "truth";
  options.masks_of_others = args.masks == "others";
  options.click_curve = args.curve && args.nvos.empty();
  options.alone = true;
  if (!args.nvos.empty()) options.clicks = std::numeric_limits<int>::max();  // all scribbles at once
  args.mask.apply(&options.settings);
  for (const std::string& assignment : args.set) set_setting(assignment, &options.settings);
  return options;
}

void stop_if_cancelled(const Job& job) {
  if (job.cancelled()) throw Error("splatcut-lab eval", "cancelled, nothing was written");
}

PartModel part_model_of(const EvalArguments& args) {
  return args.model.empty() ? PartModel{} : load_part_model(args.model);
}

// The measures of each scene that has the truth it takes; prints a row each.
std::vector<nlohmann::json> measure(const EvalArguments& args, const EvaluationOptions& options,
                                    const CommonOptions& common, const OutputFolder& folder, const Job& job) {
  std::vector<nlohmann::json> scores;
  const std::vector<Loader> scenes = loaders(args);
  const PrepareOptions prepare = {
      .observing = {}, .model = part_model_of(args), .cache = prepared_cache(common)};
  if (!args.json) print_heads();
  for (const Loader& load : scenes) {
    const auto loaded = load(prepare, job);
    stop_if_cancelled(job);
    warn(loaded->warning, common.quiet);
    if (lacks_truth(loaded->test, options)) {
      end_progress();
      to_stderr(fmt::format("{}: left out, it has no truth where --first-mask or --masks asks for it\n",
                            loaded->test.name));
      continue;
    }
    SceneScore score = evaluate(loaded->test, options, job);
    stop_if_cancelled(job);
    score.stages.insert(score.stages.begin(), {"load", loaded->load_ms});
    scores.push_back(score_json(score));
    if (args.any_view) {
      AnyViewOptions robot = args.robot;
      robot.preset = args.preset;
      robot.draws = std::max(1, args.draws);
      if (args.sheets)
        robot.on_sheet = [&folder](const std::string& name, const Image<Rgb8>& sheet) {
          write_png(folder.file(name + ".png"), sheet);
        };
      scores.back().update(any_view_json(*loaded, robot, job));
      stop_if_cancelled(job);
    } else if (args.draws > 0) {
      const ClickDraws draws = draw_clicks(loaded->test, options.settings, kRobotClicks, args.draws, job);
      stop_if_cancelled(job);
      if (!draws.median.empty()) scores.back()["draws"] = draws_json(draws);
    }
    end_progress();
    if (!args.json) print_row(scores.back());
    std::fflush(stdout);
  }
  return scores;
}

// How many strokes of each scene the final cut was told.
nlohmann::json clicks_json(const EvalArguments& args) {
  if (!args.nvos.empty()) return "all";
  return first_mask_is_truth(args) || args.masks == "others" ? 0 : args.clicks;
}

// One way in, and what it needs.
void check_ways_in(const EvalArguments& args) {
  const int ways = !args.suite.empty() + !args.nvos.empty() + !args.spin_nerf.empty();
  if (ways != 1) throw CLI::ArgumentMismatch("give one of suite, --nvos and --spin-nerf");
  if (args.suite.empty() == args.scenes.empty())
    throw CLI::ArgumentMismatch("--scenes goes with --nvos and --spin-nerf, and they with it");
  if (!args.nvos.empty() && args.mask.first_mask == "truth")
    throw CLI::ArgumentMismatch("--first-mask truth: NVOS has no true mask of the reference view");
  if (args.clicks_given && (!args.nvos.empty() || first_mask_is_truth(args)))
    throw CLI::ArgumentMismatch(
        "--clicks: all scribbles of NVOS count, and a given mask leaves no click to make");
  if (args.masks == "others" && (args.clicks_given || args.draws > 0 || args.suite.empty() ||
                                 !args.mask.first_mask.empty() || args.mask.parts_only))
    throw CLI::ArgumentMismatch(
        "--masks others: takes a suite, and nothing but its masks says what is meant");
}

// The robot's cut is the window's, which knows presets and nothing else.
void check_any_view(const EvalArguments& args) {
  if (!args.any_view) {
    if (args.robot_asked)
      throw CLI::ArgumentMismatch(
          "--robot-clicks, --starts, --from-box, --zoom, --near, --details, --choices, --sizes, --sheets and "
          "--perturb go with --any-view");
    return;
  }
  const MaskOptions& mask = args.mask;
  const bool masks_set = !mask.first_mask.empty() || !mask.propagate.empty() || !mask.refine.empty() ||
                         mask.views >= 0 || mask.parts_only || !args.masks.empty();
  if (masks_set || !args.set.empty())
    throw CLI::ArgumentMismatch(
        "--any-view runs a preset as the window does: no --set and no choice of masks");
  if (!args.spin_nerf.empty()) throw CLI::ArgumentMismatch("--any-view clicks, SPIn-NeRF gives masks");
}

void run_eval(const EvalArguments& args, const CommonOptions& common) {
  check_ways_in(args);
  check_any_view(args);
  refuse_written_inputs(args.output, {args.suite, args.nvos, args.spin_nerf, args.scenes, args.model});
  const Job job =
      console_job(common.quiet);  // first: Ctrl+C must find its handler once there is a folder to remove
  OutputFolder folder(args.output, args.overwrite);
  const std::vector<nlohmann::json> scores = measure(args, evaluation_options(args), common, folder, job);
  if (scores.empty()) throw Error("splatcut-lab eval", "no scene of the suite is left to measure");
  nlohmann::json result = {{"version", version()},        {"preset", args.preset}, {"set", args.set},
                           {"clicks", clicks_json(args)}, {"draws", args.draws},   {"scenes", scores},
                           {"mean", mean_json(scores)}};
  result["values"] = values_json(evaluation_options(args).settings);
  result["part_model"] = part_model_json(part_model_of(args));
  const std::string benchmark = !args.nvos.empty() ? "NVOS" : !args.spin_nerf.empty() ? "SPIn-NeRF" : "";
  if (!benchmark.empty()) result["published"] = published_json(benchmark);
  write_text_file(folder.file("eval.json"), json_text(result, 2) + "\n");
  folder.commit();
  if (args.json) {
    fmt::print("{}\n", json_text(result, 2));
    return;
  }
  print_row(result["mean"]);
  if (args.any_view)
    print_any_view(result);
  else if (args.draws > 0)
    print_draws(result, args.draws);
  print_alone(result);
  if (common.quiet) return;
  for (const PublishedScore& p : published_scores())
    if (p.benchmark == benchmark)
      fmt::print("published: {:<40} img IoU {}, acc {}\n", p.method, p.iou,
                 p.accuracy.empty() ? "-" : p.accuracy);
}

}  // namespace

CLI::Option* add_box_option(CLI::App& command, std::optional<float>* margin) {
  constexpr double kPercent = 0.01;
  return command
      .add_option_function<double>(
          "--from-box", [margin](const double& percent) { *margin = static_cast<float>(kPercent * percent); },
          "It begins with a box around the truth, so many percent of its extent larger on each side; below 0 "
          "the box cuts into it; with an unsteady hand each side by another share, up to twice as much")
      ->check(CLI::Range(-30.0, 100.0));
}

void add_eval_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<EvalArguments>();
  CLI::App& command = *program.add_subcommand("eval", "Measure cutouts against truth on a suite of scenes");
  command.footer(
      "One command a table of the GaussianCut paper, where RUNS holds a 3DGS output per scene:\n"
      "  Tables 1, 3 (NVOS):       splatcut-lab eval --nvos nvos/labels/llff --scenes RUNS -o OUT\n"
      "  Table 2 (SPIn-NeRF):      splatcut-lab eval --spin-nerf Multiview-Segmentation-Data --scenes RUNS "
      "-o "
      "OUT\n"
      "  Table 4 (Shiny):          splatcut-lab eval --spin-nerf YOUR_MASKS --scenes RUNS -o OUT    (a "
      "folder of "
      "masks per scene)\n"
      "RUNS/SCENE: point_cloud/iteration_N/point_cloud.ply or one .ply, and cameras.json, sparse/0 or "
      "transforms.json.\n"
      "NVOS: reference_image/SCENE/NAME.JPG, scribbles/SCENE/pos_*.png neg_*.png, "
      "masks/SCENE/NAME_mask.png.\n"
      "SPIn-NeRF: SCENE/NAME.png, or in SCENE/label, masks or images_N/label; the first by name is given, "
      "the others are scored.");
  command.add_option("suite", args->suite, "suite.json");
  command.add_option("--nvos", args->nvos,
                     "Folder with scribbles, masks and reference_image, as NVOS is released; wants --scenes");
  command.add_option("--spin-nerf", args->spin_nerf,
                     "Folder with a mask per picture and scene, as SPIn-NeRF is released; wants --scenes");
  command.add_option("--scenes", args->scenes, "Folder of the reconstructions, one folder a scene");
  command.add_option("-o,--output", args->output, "Folder for eval.json")->required();
  command.add_option("--clicks", args->clicks, "Clicks for the final cut")->check(CLI::Range(1, 8));
  command.add_option("--draws", args->draws, "The first mask again with that many draws of unsteady clicks")
      ->check(CLI::Range(0, 1000));
  command.add_flag(
      "--any-view", args->any_view,
      "The any-view robot, too: on the window's own cut it clicks the middle of the largest error of any "
      "view whose truth is known; each such view is a start in turn. --draws then are its own");
  command.add_option("--robot-clicks", args->robot.clicks, "Its clicks a session")->check(CLI::Range(1, 50));
  command.add_option("--starts", args->robot.starts, "Its first so many starts; 0: all")
      ->check(CLI::Range(0, 1000));
  command.add_flag("--zoom", args->robot.zoom,
                   "Its first click again with the camera at .4, .6, 1, 2 and 4 times the distance");
  command
      .add_option(
          "--near", args->robot.near,
          "Its later clicks with the camera at that share of the distance, as one who zooms in to mend")
      ->check(CLI::Range(0.2, 1.0));
  command
      .add_option(
          "--details", args->robot.details,
          "Its later clicks on any wrong region whose middle lies so many pixels from its border, by chance, "
          "in place of the largest one")
      ->check(CLI::Range(1.0, 100.0));
  add_box_option(command, &args->robot.box_margin)->excludes("--zoom");
  command.add_flag(
      "--choices", args->robot.choices,
      "It takes what is offered for its first click where that is better; a choice costs a click");
  command.add_flag("--sizes", args->robot.sizes,
                   "It turns the wheel after a click as long as the clicked view gets better by that");
  command
      .add_option(
          "--perturb", args->robot.copies,
          "Its clicks again on so many copies of the scene: rounded .ply, .compressed.ply, .splat, .spz, "
          "rows shuffled, splats moved by a hundredth of their size, and so on")
      ->check(CLI::Range(1, 100))
      ->excludes("--choices");  // it plays clicks again
  command.add_flag(
      "--sheets", args->sheets,
      "A picture a session, sheet_SCENE_START.png: the clicked view before and after each click");
  command.add_option("--only", args->only, "Scenes, by name");
  args->mask.add_to(command, true);
  command
      .add_option(
          "--masks", args->masks,
          "truth: the true masks in all orbit views; others: no clicks, each test view left out in turn "
          "and the true masks of the others given")
      ->check(CLI::IsMember({"truth", "others"}));
  command.add_option("--model", args->model, "Weights of the parts in place of those that are shipped")
      ->group("");  // for experiments: not listed
  add_setting_options(command, &args->preset, &args->set);
  command.add_flag("!--no-curve", args->curve, "Leave out the figures after 1..8 clicks");
  command.add_flag("--json", args->json, "Print JSON");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &command, &common] {
    args->clicks_given = command.count("--clicks") > 0;
    for (const char* option : {"--robot-clicks", "--starts", "--from-box", "--zoom", "--near", "--details",
                               "--choices", "--sizes", "--sheets", "--perturb"})
      args->robot_asked |= command.count(option) > 0;
    run_eval(*args, common);
  });
}

}  // namespace splatcut
