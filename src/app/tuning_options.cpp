#include "app/tuning_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <utility>

#include "scene/error.h"

namespace splatcut {

namespace {

template <class Number>
bool read(std::string_view text, Number low, Number high, Number* value) {
  Number read{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (failure != std::errc() || end != text.data() + text.size() || !(read >= low && read <= high))
    return false;
  *value = read;
  return true;
}

// `field`: a function from CutSettings& to a reference to what is set.
template <class Field, class Number>
TuningOption number(std::string name, Number low, Number high, Field field) {
  return {
      std::move(name),
      fmt::format("a {} from {} to {}", std::is_integral_v<Number> ? "whole number" : "number", low, high),
      [=](std::string_view text, CutSettings* o) { return read(text, low, high, &field(*o)); }};
}

template <class Field>
TuningOption flag(std::string name, Field field) {
  return {std::move(name), "0 or 1", [=](std::string_view text, CutSettings* o) {
            if (text != "0" && text != "1") return false;
            field(*o) = text == "1";
            return true;
          }};
}

template <class Value, class Field>
TuningOption choice(std::string name, std::vector<std::pair<std::string_view, Value>> values, Field field) {
  std::string words;
  for (std::size_t i = 0; i < values.size(); ++i)
    words += std::string(i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + std::string(values[i].first);
  return {std::move(name), words, [=](std::string_view text, CutSettings* o) {
            const auto it = std::ranges::find(values, text, &std::pair<std::string_view, Value>::first);
            if (it == values.end()) return false;
            field(*o) = it->second;
            return true;
          }};
}

// The field `member` of the energy.
template <class Member>
auto of_energy(Member EnergyOptions::*member) {
  return [member](CutSettings& o) -> Member& { return o.cut.energy.*member; };
}

template <class Member>
auto of_pipeline(Member CutSettings::*member) {
  return [member](CutSettings& o) -> Member& { return o.*member; };
}

template <class Member>
auto of_cut(Member CutOptions::*member) {
  return [member](CutSettings& o) -> Member& { return o.cut.*member; };
}

std::vector<TuningOption> make_table() {
  using E = EnergyOptions;
  constexpr float kLargestGamma = 1000;
  const std::vector<std::pair<std::string_view, Pairwise>> kinds = {{"overlap", Pairwise::kOverlap},
                                                                    {"distance", Pairwise::kDistance},
                                                                    {"paper", Pairwise::kPaper},
                                                                    {"paper-code", Pairwise::kPaperCode}};
  const std::vector<std::pair<std::string_view, Propagator>> propagators = {
      {"lift", Propagator::kLift}, {"warp", Propagator::kWarp}, {"dis", Propagator::kFlow}};
  const std::vector<std::pair<std::string_view, MaskSolver>> solvers = {
      {"none", MaskSolver::kNone}, {"grabcut", MaskSolver::kGrabCut}, {"pixelcut", MaskSolver::kPixelCut}};
  const std::vector<std::pair<std::string_view, FirstMaskFrom>> ways_in = {
      {"parts", FirstMaskFrom::kParts}, {"pixels", FirstMaskFrom::kPixels}};
  return {
      choice("energy.pairwise", kinds, of_energy(&E::pairwise)),
      number("energy.gamma_position", 0.0f, kLargestGamma, of_energy(&E::gamma_position)),
      number("energy.gamma_colour", 0.0f, kLargestGamma, of_energy(&E::gamma_colour)),
      number("energy.concavity", 0.0f, kLargestGamma, of_energy(&E::concavity)),
      number("smoothness", 0.0f, 500.0f, [](CutSettings& o) -> float& { return o.smoothness.emplace(); }),
      number("energy.lambda", 0.0f, 500.0f, of_energy(&E::lambda)),
      flag("energy.visibility", of_energy(&E::visibility)),
      number("energy.v0", 0.0f, 1000.0f, of_energy(&E::v0_px_per_view_at_400)),
      number("energy.lambda_n", 0.0f, 100.0f, of_energy(&E::lambda_n)),
      number("energy.lambda_u", 0.0f, 100.0f, of_energy(&E::lambda_u)),
      number("energy.gamma_cluster_position", 0.0f, kLargestGamma, of_energy(&E::gamma_cluster_position)),
      number("energy.gamma_cluster_colour", 0.0f, kLargestGamma, of_energy(&E::gamma_cluster_colour)),
      number("energy.object_clusters", 1, 100, of_energy(&E::object_clusters)),
      number("energy.rest_clusters", 1, 100, of_energy(&E::rest_clusters)),
      number("energy.unseen_rest", 0.0f, 100.0f, of_energy(&E::unseen_rest)),
      flag("energy.hard", of_pipeline(&CutSettings::hard_counts)),
      flag("energy.coarse", of_cut(&CutOptions::coarse)),
      number("energy.tau", 0.0f, 1.0f, of_cut(&CutOptions::tau)),
      choice("views.propagate", propagators, of_pipeline(&CutSettings::propagate)),
      choice("views.refine", solvers, [](CutSettings& o) -> MaskSolver& { return o.refine.solver; }),
      number("views.refine_band_px", 1, 100, [](CutSettings& o) -> int& { return o.refine.band_px; }),
      number("views.refine_grow_px", 0, 100, [](CutSettings& o) -> int& { return o.refine.grow_px; }),
      number("views.refine_lambda", 0.0f, 1000.0f, [](CutSettings& o) -> float& { return o.refine.lambda; }),
      number("views.refine_prior", 0.0f, 1000.0f,
             [](CutSettings& o) -> float& { return o.refine.prior_weight; }),
      flag("views.hidden_test", of_pipeline(&CutSettings::hidden_test)),
      number("views.most", 0, 400, [](CutSettings& o) -> int& { return o.orbit.views; }),
      number("views.distance_sizes", 0.5f, 10.0f,
             [](CutSettings& o) -> float& { return o.orbit.distance_sizes; }),
      number("views.settled_change", 0.0, 1.0, of_pipeline(&CutSettings::settled_change)),
      number("views.settled", 1, 400, of_pipeline(&CutSettings::settled_views)),
      number("views.agreement", 0.0, 1.0, of_pipeline(&CutSettings::view_agreement)),
      number("work_width_px", 32, 8192, of_pipeline(&CutSettings::work_width_px)),
      number("least_object_px", 0, 4096, of_pipeline(&CutSettings::least_object_px)),
      choice("first.from", ways_in, of_pipeline(&CutSettings::first_mask_from)),
      choice("first.solver", solvers,
             [](CutSettings& o) -> MaskSolver& { return o.first_mask.refine.solver; }),
      number("pick.late_growth_penalty", 0.0f, 100.0f,
             [](CutSettings& o) -> float& { return o.pick.late_growth_penalty; }),
      number("pick.joint_bonus", 0.0f, 100.0f, [](CutSettings& o) -> float& { return o.pick.joint_bonus; }),
      number("pick.rest_most_of_selected", 0.0f, 100.0f,
             [](CutSettings& o) -> float& { return o.pick.rest_most_of_selected; }),
      number("pick.change_most_of_selected", 0.0f, 100.0f,
             [](CutSettings& o) -> float& { return o.pick.change_most_of_selected; }),
      flag("pick.join_enclosed", of_pipeline(&CutSettings::join_enclosed)),
      number("neighbours", 1, 254, of_pipeline(&CutSettings::neighbours)),
      flag("trim", of_pipeline(&CutSettings::trim)),
      number("prior_px_per_view", 0.0f, 1000.0f, of_pipeline(&CutSettings::prior_px_per_view)),
  };
}

}  // namespace

const std::vector<TuningOption>& tuning_options() {
  static const std::vector<TuningOption> table = make_table();
  return table;
}

void set_tuning_option(std::string_view assignment, CutSettings* options) {
  const std::size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string name(assignment.substr(0, equals));
  const auto it = std::ranges::find(tuning_options(), name, &TuningOption::name);
  if (it == tuning_options().end()) {
    std::string names;
    for (const TuningOption& option : tuning_options()) names += (names.empty() ? "" : ", ") + option.name;
    throw Error(assignment, fmt::format("there is no setting \"{}\"", name),
                "Take NAME=VALUE with one of " + names);
  }
  if (equals == assignment.size() || !it->set(assignment.substr(equals + 1), options))
    throw Error(assignment, fmt::format("{} takes {}", name, it->values));
}

void add_tuning_options(CLI::App& command, std::vector<std::string>* assignments) {
  const auto problem_with = [](const std::string& assignment) -> std::string {
    CutSettings ignored;
    try {
      set_tuning_option(assignment, &ignored);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  command
      .add_option("--set", *assignments,
                  "NAME=VALUE: a setting of the energy or the pipeline by its name (a wrong one lists them)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->check(problem_with);
}

}  // namespace splatcut
