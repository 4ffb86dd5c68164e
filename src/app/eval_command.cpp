// splatcut eval: the measures of a suite, as a table and as JSON.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/eval_suite.h"
#include "app/mask_options.h"
#include "app/output_folder.h"
#include "app/tuning_options.h"
#include "scene/atomic_file.h"
#include "segment/click_draws.h"

namespace splatcut {

namespace {

struct EvalArguments {
  std::filesystem::path suite, output;
  std::string preset = "default", masks;
  MaskOptions mask;
  std::vector<std::string> set;
  int clicks = 3, draws = 0;
  bool curve = true, json = false, overwrite = false;
};

nlohmann::json score_json(const SceneScore& s) {
  nlohmann::json j = {{"name", s.name}, {"image_iou", s.image_iou}, {"accuracy", s.accuracy}, {"boundary_iou", s.boundary_iou},
                      {"mask_iou_after_clicks", s.mask_iou_after_clicks}, {"total_ms", s.total_ms}, {"ms", nlohmann::json::object()}};
  j["gaussian_iou"] = s.gaussian_iou ? nlohmann::json(*s.gaussian_iou) : nullptr;
  j["noc85"] = s.noc85 ? nlohmann::json(*s.noc85) : nullptr;
  j["noc90"] = s.noc90 ? nlohmann::json(*s.noc90) : nullptr;
  j["image_iou_after_clicks"] = nlohmann::json::object();
  for (const auto& [n, value] : s.image_iou_after_clicks) j["image_iou_after_clicks"][std::to_string(n)] = value;
  for (const StageTime& stage : s.stages) j["ms"][stage.name] = stage.ms;
  return j;
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
  nlohmann::json mean = scores.empty() ? nlohmann::json::object() : scores.front();
  mean["name"] = "mean";
  for (const auto& s : scores) {
    const nlohmann::json flat = s.flatten();  // named: items() only refers to it
    for (const auto& [at, value] : flat.items())
      if (value.is_number()) mean[nlohmann::json::json_pointer(at)] = mean_of(nlohmann::json::json_pointer(at));
  }
  return mean;
}

void print_row(const nlohmann::json& s) {
  const auto number = [&s](const char* key, const char* form) {
    return s.contains(key) && s.at(key).is_number() ? fmt::format(fmt::runtime(form), s.at(key).get<double>()) : std::string("-");
  };
  const auto after = [&s](const char* n) {
    const auto& curve = s.value("image_iou_after_clicks", nlohmann::json::object());
    return curve.contains(n) ? fmt::format("{:.3f}", curve.at(n).get<double>()) : std::string("-");
  };
  fmt::print("{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>6} {:>8}\n", s.value("name", ""), number("image_iou", "{:.3f}"),
             number("accuracy", "{:.4f}"), number("boundary_iou", "{:.3f}"), number("gaussian_iou", "{:.3f}"), after("1"),
             after("3"), after("5"), number("noc90", "{:.1f}"), number("total_ms", "{:.0f}"));
}

nlohmann::json draws_json(const ClickDraws& d) {
  return {{"median", d.median}, {"least", d.least}, {"mean_noc85", d.mean_noc85}, {"mean_noc90", d.mean_noc90},
          {"most_noc90", d.most_noc90}, {"least_from_second_click", d.least_from_second}};
}

// The first mask under an unsteady hand, a row per scene.
void print_draws(const std::vector<nlohmann::json>& scores, int draws) {
  fmt::print("\nfirst mask, IoU after 1..{} clicks, median / least of {} draws\n", kRobotClicks, draws);
  for (const nlohmann::json& s : scores) {
    if (!s.contains("draws")) continue;
    const nlohmann::json& d = s.at("draws");
    fmt::print("{:<16}", s.value("name", ""));
    for (std::size_t k = 0; k < d.at("median").size(); ++k)
      fmt::print(" {:.3f}/{:.3f}", d.at("median")[k].get<double>(), d.at("least")[k].get<double>());
    if (d.contains("mean_noc90"))
      fmt::print("  NoC85 {:.2f} NoC90 {:.2f}, most {}", d.at("mean_noc85").get<double>(), d.at("mean_noc90").get<double>(), d.at("most_noc90").get<double>());
    fmt::print("\n");
  }
}

// --first-mask truth needs the truth of the reference view, --masks truth that of any view.
bool lacks_truth(const EvaluationCase& test, const EvaluationOptions& options) {
  return (options.truth_first_mask && !test.reference_truth) || (options.truth_masks && test.truth_labels.empty());
}

void run_eval(const EvalArguments& args, const CommonOptions& common) {
  const Job job = console_job(common.quiet);  // first: Ctrl+C must find its handler once there is a folder to remove
  OutputFolder folder(args.output, args.overwrite);
  EvaluationOptions options;
  options.pipeline = preset(args.preset);
  options.pipeline.cache = prepared_cache(common);
  options.clicks = args.clicks;
  options.truth_first_mask = args.mask.first_mask == "truth";
  options.truth_masks = args.masks == "truth";
  options.click_curve = args.curve;
  args.mask.apply(&options.pipeline);
  for (const std::string& assignment : args.set) set_tuning_option(assignment, &options.pipeline);
  std::vector<nlohmann::json> scores;
  if (!args.json)
    fmt::print("{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>6} {:>8}\n", "scene", "img IoU", "acc", "bnd IoU", "gau IoU",
               "1 click", "3", "5", "NoC90", "ms");
  for (const nlohmann::json& entry : read_suite(args.suite)) {
    const auto loaded = load_case(entry, args.suite.parent_path(), prepare_options(options.pipeline), job);
    if (job.cancelled()) throw Error("splatcut eval", "cancelled, nothing was written");
    warn(loaded->warning, common.quiet);
    if (lacks_truth(loaded->test, options)) {
      end_progress();
      fmt::print(stderr, "{}: left out, it has no truth where --first-mask or --masks asks for it\n", loaded->test.name);
      continue;
    }
    SceneScore score = evaluate(loaded->test, options, job);
    if (job.cancelled()) throw Error("splatcut eval", "cancelled, nothing was written");
    score.stages.insert(score.stages.begin(), loaded->prepared.stages.begin(), loaded->prepared.stages.end());
    score.stages.insert(score.stages.begin(), {"load", loaded->load_ms});
    scores.push_back(score_json(score));
    if (args.draws > 0) {
      const ClickDraws draws = draw_clicks(loaded->test, options.pipeline, kRobotClicks, args.draws, job);
      if (job.cancelled()) throw Error("splatcut eval", "cancelled, nothing was written");
      if (!draws.median.empty()) scores.back()["draws"] = draws_json(draws);
    }
    end_progress();
    if (!args.json) print_row(scores.back());
    std::fflush(stdout);
  }
  if (scores.empty()) throw Error("splatcut eval", "no scene of the suite is left to measure");
  const nlohmann::json result = {{"version", SPLATCUT_VERSION}, {"preset", args.preset}, {"set", args.set}, {"clicks", args.clicks}, {"draws", args.draws},
                                 {"scenes", scores}, {"mean", mean_json(scores)}};
  write_text_file(folder.file("eval.json"), result.dump(2) + "\n");
  folder.commit();
  if (args.json)
    fmt::print("{}\n", result.dump(2));
  else
    print_row(result["mean"]);
  if (!args.json && args.draws > 0) {
    scores.push_back(result["mean"]);
    print_draws(scores, args.draws);
  }
}

}  // namespace

void add_eval_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<EvalArguments>();
  CLI::App& command = *program.add_subcommand("eval", "Measure cutouts against truth on a suite of scenes");
  command.add_option("suite", args->suite, "suite.json")->required();
  command.add_option("-o,--output", args->output, "Folder for eval.json")->required();
  command.add_option("--preset", args->preset, "fast, default, best, paper or paper-code");
  command.add_option("--clicks", args->clicks, "Clicks for the final cut")->check(CLI::Range(1, 8));
  command.add_option("--draws", args->draws, "The first mask again with that many draws of unsteady clicks")->check(CLI::Range(0, 1000));
  args->mask.add_to(command, true);
  command.add_option("--masks", args->masks, "truth: the true masks in all orbit views")->check(CLI::IsMember({"truth"}));
  add_tuning_options(command, &args->set);
  command.add_flag("!--no-curve", args->curve, "Leave out the figures after 1..8 clicks");
  command.add_flag("--json", args->json, "Print JSON");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common] { run_eval(*args, common); });
}

}  // namespace splatcut
