// splatcut-lab fit: the weights of what a click means from scenes with truth, and what they are worth on a
// capture left out.
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "app/lab/eval_suite.h"
#include "app/lab/lab_commands.h"
#include "app/lab/part_model_file.h"
#include "app/measure/decisions.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

struct FitArguments {
  std::vector<std::filesystem::path> suites;
  std::filesystem::path output, model;
  std::vector<std::string> only, without, together;
  std::string of = "first";
  int clicks = 5;
  PartsSceneOptions scenes;
  TermFitOptions fit;
  bool zoom = false, overwrite = false;
};

// All scenes, as the robot needs them.
struct Bank {
  std::vector<std::unique_ptr<PartsScene>> scenes;
  std::vector<std::size_t> capture;  // per scene: left out together
  std::size_t captures = 0;
  bool zoomed = false;  // first clicks from kOtherDistances, too
};

struct Play {
  std::size_t scene, start;
};

using Curve = std::vector<double>;

// Mean IoU of one scene: after 1, 2, ... clicks, and after one from nearer and farther.
struct Score {
  Curve after, zoomed;  // NaN where no first click hits the same thing from there
};

constexpr std::array kOtherDistances = {0.4f, 0.6f, 2.0f, 4.0f};

void stop_if_fit_cancelled(const Job& job) {
  if (job.cancelled()) throw Error("splatcut-lab fit", "cancelled, nothing was written");
}

Bank load_bank(const FitArguments& args, const PrepareOptions& prepare, const Job& job) {
  Bank bank;
  bank.zoomed = args.zoom;
  PartsSceneOptions options = args.scenes;
  if (args.zoom) options.zooms.insert(options.zooms.end(), kOtherDistances.begin(), kOtherDistances.end());
  std::map<std::filesystem::path, std::size_t> captures;
  std::vector<std::string> names;
  for (const std::filesystem::path& suite : args.suites)
    for (const nlohmann::json& entry : read_suite(suite)) names.push_back(entry.value("name", ""));
  refuse_unknown("--only", args.only, names);
  refuse_unknown("--together", args.together, names);
  for (const std::filesystem::path& suite : args.suites)
    for (const nlohmann::json& entry : read_suite(suite)) {
      if (!args.only.empty() && std::ranges::find(args.only, entry.value("name", "")) == args.only.end())
        continue;
      const auto loaded = load_case(entry, suite.parent_path(), prepare, job);
      stop_if_fit_cancelled(job);
      const EvaluationCase& test = loaded->test;
      PreparedScene whole = prepare_scene(
          *test.cloud, observing_views(*test.cloud, test.reference, test.up_world, test.scene_cameras),
          prepare, job);
      stop_if_fit_cancelled(job);
      bank.scenes.push_back(std::make_unique<PartsScene>(
          parts_scene(test, std::move(whole.parts), options, Job{job.stop, {}})));
      std::filesystem::path capture = suite.parent_path() / entry.at("scene").get<std::string>();
      if (std::ranges::find(args.together, loaded->test.name) != args.together.end()) capture.clear();
      bank.capture.push_back(captures.try_emplace(capture, captures.size()).first->second);
    }
  if (bank.scenes.empty()) throw Error("splatcut-lab fit", "no scene of the suites is left to fit to");
  bank.captures = captures.size();
  return bank;
}

std::vector<Play> plays_of(const Bank& bank) {
  std::vector<Play> plays;
  for (std::size_t i = 0; i < bank.scenes.size(); ++i)
    for (std::size_t s = 0; s < bank.scenes[i]->starts.size(); ++s) plays.push_back({i, s});
  return plays;
}

std::vector<Decision> all_decisions(const Bank& bank, const SelectionModel& model, int clicks,
                                    const Job& job) {
  const std::vector<Play> plays = plays_of(bank);
  std::vector<std::vector<Decision>> of_play(plays.size());
  tbb::parallel_for(std::size_t{0}, plays.size(), [&](std::size_t p) {
    if (job.cancelled()) return;
    const PartsScene& scene = *bank.scenes[plays[p].scene];
    of_play[p] = decisions_of(scene, model, scene.starts[plays[p].start], clicks);
    for (Decision& d : of_play[p]) d.scene = plays[p].scene;
  });
  std::vector<Decision> all;
  for (auto& some : of_play) std::ranges::move(some, std::back_inserter(all));
  return all;
}

// Of those that are numbers; NaN where none is.
Curve mean_curve(const std::vector<Curve>& curves) {
  Curve mean(curves.empty() ? 0 : curves.front().size(), 0);
  for (std::size_t c = 0; c < mean.size(); ++c) {
    double count = 0;
    for (const Curve& curve : curves) {
      if (std::isnan(curve[c])) continue;
      mean[c] += curve[c];
      ++count;
    }
    mean[c] /= count;
  }
  return mean;
}

// Every scene's score, each scene with the model given for it.
std::vector<Score> scores(const Bank& bank, const std::vector<SelectionModel>& model_of_scene, int clicks,
                          const Job& job) {
  const std::vector<Play> plays = plays_of(bank);
  std::vector<Curve> of_play(plays.size());
  tbb::parallel_for(std::size_t{0}, plays.size(), [&](std::size_t p) {
    if (job.cancelled()) return;
    const PartsScene& scene = *bank.scenes[plays[p].scene];
    const AnyViewWorld world = parts_world(scene, model_of_scene[plays[p].scene]);
    const int played = scene.zoom[plays[p].start] == 1 ? clicks : 1;
    of_play[p] = any_view_session(world, scene.starts[plays[p].start], played, {}, job).iou_after;
  });
  stop_if_fit_cancelled(job);
  const auto mean_at = [&](std::size_t scene, float zoom) {
    std::vector<Curve> some;
    for (std::size_t p = 0; p < plays.size(); ++p)
      if (plays[p].scene == scene && bank.scenes[scene]->zoom[plays[p].start] == zoom)
        some.push_back(of_play[p]);
    return mean_curve(some);
  };
  std::vector<Score> all;
  for (std::size_t i = 0; i < bank.scenes.size(); ++i) {
    Score score{mean_at(i, 1), {}};
    for (const float zoom : kOtherDistances) {
      if (!bank.zoomed) break;
      const Curve at = mean_at(i, zoom);
      score.zoomed.push_back(at.empty() ? std::numeric_limits<double>::quiet_NaN() : at.front());
    }
    all.push_back(std::move(score));
  }
  return all;
}

struct FitTable {
  SelectionModel shipped, fitted;
  std::vector<SelectionModel> without;                  // per scene: fitted without its capture
  std::vector<Score> as_shipped, with, without_scores;  // per scene
};

FitTable fit_table(const Bank& bank, const FitArguments& args, const SelectionModel& shipped,
                   const Job& job) {
  constexpr std::pair<DecisionOf, TermValues SelectionModel::*> kFitted[] = {
      {DecisionOf::kFirstClick, &SelectionModel::first},
      {DecisionOf::kCorrection, &SelectionModel::later},
      {DecisionOf::kBox, &SelectionModel::box}};
  const auto& row = kFitted[args.of == "first" ? 0 : args.of == "later" ? 1 : 2];
  const DecisionOf which = row.first;
  const auto terms = row.second;
  job.progress("sessions as shipped", 0.1);
  const std::vector<Decision> decisions =
      all_decisions(bank, shipped, args.of == "later" ? args.clicks : 1, job);
  stop_if_fit_cancelled(job);
  const auto is_of = [&](const Decision& d) { return d.of == which; };
  if (std::ranges::none_of(decisions, is_of))
    throw Error("splatcut-lab fit", "the sessions hold no decision of that kind",
                "Take more scenes, more clicks or another --of");
  const auto fitted = [&](const std::vector<bool>& in_scene) {
    SelectionModel model = shipped;
    if (std::ranges::any_of(decisions, [&](const Decision& d) { return is_of(d) && in_scene[d.scene]; }))
      model.*terms = fitted_terms(decisions, which, in_scene, args.fit);
    return model;
  };
  FitTable table{.shipped = shipped,
                 .fitted = fitted(std::vector<bool>(bank.scenes.size(), true)),
                 .without = std::vector<SelectionModel>(bank.scenes.size(), shipped),
                 .as_shipped = {},
                 .with = {},
                 .without_scores = {}};
  job.progress("fits without each capture", 0.5);
  tbb::parallel_for(std::size_t{0}, bank.captures, [&](std::size_t left_out) {
    if (job.cancelled() || bank.captures == 1) return;
    std::vector<bool> others;
    for (const std::size_t capture : bank.capture) others.push_back(capture != left_out);
    const SelectionModel model = fitted(others);
    for (std::size_t i = 0; i < others.size(); ++i)
      if (!others[i]) table.without[i] = model;
  });
  job.progress("sessions with the fits", 0.6);
  const auto same = [&](const SelectionModel& model) {
    return std::vector<SelectionModel>(bank.scenes.size(), model);
  };
  table.as_shipped = scores(bank, same(shipped), args.clicks, job);
  table.with = scores(bank, same(table.fitted), args.clicks, job);
  if (bank.captures > 1) table.without_scores = scores(bank, table.without, args.clicks, job);
  return table;
}

Score mean_score(const std::vector<Score>& of) {
  std::vector<Curve> after, zoomed;
  for (const Score& score : of) {
    after.push_back(score.after);
    if (!score.zoomed.empty()) zoomed.push_back(score.zoomed);
  }
  return {mean_curve(after), mean_curve(zoomed)};
}

std::string cells(const Score& score) {
  std::string row;
  for (const std::size_t clicks : {1, 2, 3, 5, 10})
    if (clicks <= score.after.size()) row += fmt::format(" {:.3f}", score.after[clicks - 1]);
  if (!score.zoomed.empty()) row += " x";
  for (const double iou : score.zoomed) row += std::isnan(iou) ? "     -" : fmt::format(" {:.3f}", iou);
  return row.empty() ? " -" : row;
}

void print_table(const Bank& bank, const FitTable& table) {
  fmt::print(
      "IoU after 1, 2, 3, 5, 10 clicks (x: after one from {} of the distance): as shipped | fitted with the "
      "scene | fitted without its capture\n",
      fmt::join(kOtherDistances, ", "));
  const auto row = [](const std::string& name, const Score& a, const Score& b, const Score& c) {
    fmt::print("{:<16}{} |{} |{}\n", name, cells(a), cells(b), cells(c));
  };
  for (std::size_t i = 0; i < bank.scenes.size(); ++i)
    row(bank.scenes[i]->name, table.as_shipped[i], table.with[i],
        table.without_scores.empty() ? Score{} : table.without_scores[i]);
  row("mean", mean_score(table.as_shipped), mean_score(table.with), mean_score(table.without_scores));
  PartModel shipped, fitted;
  shipped.selection = table.shipped;
  fitted.selection = table.fitted;
  for (const PartWeight& weight : part_weights())
    if (weight.get(shipped) != weight.get(fitted))
      fmt::print("{}: {:g} as shipped, {:g} fitted\n", weight.name, weight.get(shipped), weight.get(fitted));
}

nlohmann::json table_json(const Bank& bank, const FitArguments& args, const FitTable& table) {
  const auto weights = [](const SelectionModel& selection) {
    PartModel model;
    model.selection = selection;
    return part_model_json(model).at("weights");
  };
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < bank.scenes.size(); ++i) {
    nlohmann::json row = {{"name", bank.scenes[i]->name},
                          {"capture", bank.capture[i]},
                          {"starts", bank.scenes[i]->starts.size()},
                          {"shipped", table.as_shipped[i].after},
                          {"fitted_with", table.with[i].after},
                          {"fitted_without", nullptr}};
    if (!table.without_scores.empty()) {
      row["fitted_without"] = table.without_scores[i].after;
      row["weights_without"] = weights(table.without[i]);
    }
    if (args.zoom) {
      row["zoom"] = {{"of_distance", kOtherDistances},
                     {"shipped", table.as_shipped[i].zoomed},
                     {"fitted_with", table.with[i].zoomed}};
      if (!table.without_scores.empty()) row["zoom"]["fitted_without"] = table.without_scores[i].zoomed;
    }
    rows.push_back(std::move(row));
  }
  return {{"of", args.of},           {"clicks", args.clicks},
          {"steps", args.fit.steps}, {"shrink", args.fit.shrink},
          {"without", args.without}, {"weights", weights(table.fitted)},
          {"scenes", rows}};
}

std::uint32_t bits_of(const FitArguments& args) {
  std::uint32_t bits = 0;
  for (const std::string& name : args.without) {
    const auto known = std::ranges::find(term_names(), name);
    if (known == term_names().end()) throw Error(name, "is no term of a click's cost");
    bits |= 1u << (known - term_names().begin());
  }
  return bits;
}

void run_fit(FitArguments args, const CommonOptions& common) {
  refuse_written_inputs(args.output, args.suites);
  refuse_written_inputs(args.output, {args.model});
  const Job job = console_job(common.quiet);
  OutputFolder folder(args.output, args.overwrite);
  if ((args.of == "box") != args.scenes.first.box_margin.has_value() && args.of != "later")
    throw Error("splatcut-lab fit", "--of box goes with --from-box, --of first without");
  args.fit.without = bits_of(args);
  PartModel model = args.model.empty() ? PartModel() : load_part_model(args.model);
  PrepareOptions prepare;
  prepare.model = model;
  prepare.cache = prepared_cache(common);
  const Bank bank = load_bank(args, prepare, job);
  const FitTable table = fit_table(bank, args, model.selection, job);
  model.selection = table.fitted;
  write_text_file(folder.file("fit.json"), json_text(table_json(bank, args, table), 1) + "\n");
  write_text_file(folder.file("model.json"), json_text(part_model_json(model), 1) + "\n");
  folder.commit();
  end_progress();
  print_table(bank, table);
}

}  // namespace

void add_fit_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<FitArguments>();
  CLI::App& command = *program.add_subcommand(
      "fit", "Fit what clicks mean to scenes with truth, and score each scene without its capture");
  command.footer(
      "Plays the any-view robot on the parts alone, without the cut, and notes what each candidate of each "
      "click would have been worth.\nWrites fit.json (a row a scene: as shipped, fitted, fitted without its "
      "capture) and model.json (all weights).\nAll scenes stay in memory.");
  command.add_option("suites", args->suites, "suite.json files")->required()->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder for fit.json and model.json")->required();
  command
      .add_option("--of", args->of,
                  "first: what a first click means; later: what corrections mean; box: what boxes mean")
      ->check(CLI::IsMember({"first", "later", "box"}));
  command.add_option("--without", args->without,
                     "Terms whose weight stays 0, as " + fmt::format("{}", fmt::join(term_names(), " ")));
  command.add_option("--model", args->model, "Start from this model.json")->check(CLI::ExistingFile);
  command.add_option("--only", args->only, "Scenes of the suites, by name");
  command.add_option("--robot-clicks", args->clicks, "Clicks a session")->check(CLI::Range(1, 50));
  command.add_option("--together", args->together,
                     "Scenes of several files that show one capture: they are left out together");
  command.add_flag("--zoom", args->zoom, "Fit to first clicks from .4, .6, 2 and 4 times the distance, too");
  add_box_option(command, &args->scenes.first.box_margin)->excludes("--zoom");
  command.add_option("--starts", args->scenes.most_starts, "The first so many starts of each scene")
      ->check(CLI::Range(1, 1000));
  command.add_option("--views", args->scenes.most_views, "At most so many views with truth of each scene")
      ->check(CLI::Range(1, 1000));
  command.add_option("--shrink", args->fit.shrink, "How much small weights are preferred")
      ->check(within(0, 1e6));
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common] { run_fit(*args, common); });
}

}  // namespace splatcut
