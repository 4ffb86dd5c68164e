#include "segment/session/settings_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/error.h"
#include "core/spoken_list.h"

namespace splatcut {

namespace {

constexpr auto kPeople = SettingFor::kPeople;
constexpr auto kExperiments = SettingFor::kExperiments;

template <class Number>
bool read(std::string_view text, Number low, Number high, Number* value) {
  Number read{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (failure != std::errc() || end != text.data() + text.size() || !(read >= low && read <= high))
    return false;
  *value = read;
  return true;
}

template <class Number>
std::string range(Number low, Number high) {
  return fmt::format("a {} from {} to {}", std::is_integral_v<Number> ? "whole number" : "number", low, high);
}

// `field`: from settings, const or not, to a reference to what is set.
template <class Number, class Field>
Setting number(std::string name, SettingFor whom, Number low, Number high, Field field,
               std::string sentence) {
  return {std::move(name),
          whom,
          std::move(sentence),
          range(low, high),
          [=](std::string_view text, CutSettings* s) { return read(text, low, high, &field(*s)); },
          [=](const CutSettings& s) { return fmt::format("{}", field(s)); }};
}

template <class Field>
Setting flag(std::string name, SettingFor whom, Field field, std::string sentence) {
  return {std::move(name),
          whom,
          std::move(sentence),
          "0 or 1",
          [=](std::string_view text, CutSettings* s) {
            if (text != "0" && text != "1") return false;
            field(*s) = text == "1";
            return true;
          },
          [=](const CutSettings& s) { return std::string(field(s) ? "1" : "0"); }};
}

template <class Value>
using Names = std::vector<std::pair<std::string_view, Value>>;

template <class Row>
Names<Row> choices_of(const std::vector<Row>& rows) {
  Names<Row> names;
  for (const Row& row : rows) names.emplace_back(row.name, row);
  return names;
}

// "lift: labels of the cut rendered into the next view; warp: masks through depth; ..."
std::string sentence_of(const std::vector<Propagator>& rows) {
  std::vector<std::string> sentences;
  for (const Propagator& row : rows) sentences.push_back(fmt::format("{}: {}", row.name, row.sentence));
  return fmt::format("{}", fmt::join(sentences, "; "));
}

template <class Value, class Field>
Setting choice(std::string name, SettingFor whom, Names<Value> names, Field field, std::string sentence) {
  std::vector<std::string> words;
  for (const auto& [word, value] : names) words.emplace_back(word);
  return {std::move(name),
          whom,
          std::move(sentence),
          spoken_list(words),
          [=](std::string_view text, CutSettings* s) {
            const auto it = std::ranges::find(names, text, &std::pair<std::string_view, Value>::first);
            if (it == names.end()) return false;
            field(*s) = it->second;
            return true;
          },
          [=](const CutSettings& s) {
            const auto it = std::ranges::find(names, field(s), &std::pair<std::string_view, Value>::second);
            return it == names.end() ? std::string("?") : std::string(it->first);
          }};
}

// Of the last cut; without a number of its own that of all cuts.
Setting smoothness() {
  constexpr float kMost = 500;
  constexpr std::string_view kAsAll = "energy.lambda";
  return {"smoothness",
          kPeople,
          "weight of the neighbour term in the last cut: low follows the masks, high closes holes",
          range(0.0f, kMost) + ", or " + std::string(kAsAll),
          [=](std::string_view text, CutSettings* s) {
            if (text == kAsAll) return s->smoothness.reset(), true;
            float value = 0;
            if (!read(text, 0.0f, kMost, &value)) return false;
            s->smoothness = value;
            return true;
          },
          [=](const CutSettings& s) {
            return s.smoothness ? fmt::format("{}", *s.smoothness) : std::string(kAsAll);
          }};
}

// NOLINTBEGIN(bugprone-macro-parentheses): a member's name
#define FIELD(member)    \
  [](auto& s) -> auto& { \
    return s.member;     \
  }
// NOLINTEND(bugprone-macro-parentheses)

std::vector<Setting> make_table() {
  constexpr float kGamma = 1000;
  const Names<MaskSolver> solvers = {
      {"none", MaskSolver::kNone}, {"grabcut", MaskSolver::kGrabCut}, {"pixelcut", MaskSolver::kPixelCut}};
  const Names<FirstMaskFrom> ways = {{"parts", FirstMaskFrom::kParts}, {"pixels", FirstMaskFrom::kPixels}};
  return {
      number("work_width_px", kPeople, 32, 8192, FIELD(work_width_px), "views are looked at no wider"),
      number(
          "views.most", kPeople, kViewsAsNeeded, 400, FIELD(orbit.views),
          "most views around the object; -1: none after clicks, 12 where a mask or pixels say what is meant"),
      number("views.settled_change", kPeople, 0.0, 1.0, FIELD(settled_change),
             "no more views once less of the object changes; 0: all views"),
      choice("views.propagate", kPeople, choices_of(propagators()), FIELD(propagate),
             sentence_of(propagators())),
      choice("views.refine", kPeople, solvers, FIELD(refine.solver), "what settles masks in the other views"),
      choice("first.from", kPeople, ways, FIELD(first_mask_from), "where the first mask comes from"),
      choice("first.solver", kPeople, solvers, FIELD(first_mask.refine.solver),
             "what settles a first mask from pixels"),
      flag("parts_only", kPeople, FIELD(parts_only),
           "the parts are the answer: no other views, no graph cut"),
      smoothness(),
      number("energy.v0", kPeople, 0.0f, 1000.0f, FIELD(cut.energy.v0_px_per_view_at_400),
             "pixels a view that a Gaussian must show to count in full, of a picture of 400 x 300"),
      number("neighbours", kPeople, 1, 254, FIELD(neighbours), "of each Gaussian in the graph"),
      flag("energy.coarse", kPeople, FIELD(cut.coarse), "threshold the likelihood instead of the cut"),
      flag("trim", kPeople, FIELD(trim),
           "take out what shows beside the object once the scene is gone; not where --masks show it"),

      choice("energy.pairwise", kExperiments, choices_of(pairwise_energies()), FIELD(cut.energy.pairwise),
             "neighbour term, see energy.h"),
      number("energy.gamma_position", kExperiments, 0.0f, kGamma, FIELD(cut.energy.gamma_position),
             "how fast it falls with distance"),
      number("energy.gamma_colour", kExperiments, 0.0f, kGamma, FIELD(cut.energy.gamma_colour),
             "how fast it falls with colour"),
      number("energy.lambda", kExperiments, 0.0f, 500.0f, FIELD(cut.energy.lambda),
             "its weight in all cuts, but for smoothness"),
      flag("energy.visibility", kExperiments, FIELD(cut.energy.visibility),
           "what is hardly seen hardly counts"),
      number("energy.lambda_n", kExperiments, 0.0f, 100.0f, FIELD(cut.energy.lambda_n),
             "weight of colour in the paper's neighbour term"),
      number("energy.lambda_u", kExperiments, 0.0f, 100.0f, FIELD(cut.energy.lambda_u),
             "weight of the cluster term"),
      number("energy.gamma_cluster_position", kExperiments, 0.0f, kGamma,
             FIELD(cut.energy.gamma_cluster_position), "how fast that falls with distance"),
      number("energy.gamma_cluster_colour", kExperiments, 0.0f, kGamma,
             FIELD(cut.energy.gamma_cluster_colour), "how fast that falls with colour"),
      number("energy.object_clusters", kExperiments, 1, 100, FIELD(cut.energy.object_clusters),
             "clusters of the object"),
      number("energy.rest_clusters", kExperiments, 1, 100, FIELD(cut.energy.rest_clusters),
             "clusters of the rest"),
      number("energy.unseen_rest", kExperiments, 0.0f, 100.0f, FIELD(cut.energy.unseen_rest),
             "how much what no view has seen is rest"),
      flag("energy.hard", kExperiments, FIELD(hard_counts), "the likelihood counts pixels, not weights"),
      number("energy.tau", kExperiments, 0.0f, 1.0f, FIELD(cut.tau), "threshold of energy.coarse"),
      number("views.refine_band_px", kExperiments, 1, 100, FIELD(refine.band_px),
             "masks are right up to that"),
      number("views.refine_grow_px", kExperiments, 0, 100, FIELD(refine.grow_px),
             "and may grow by that much more"),
      number("views.refine_lambda", kExperiments, 0.0f, 1000.0f, FIELD(refine.lambda),
             "smoothness of the pixel cut"),
      number("views.refine_prior", kExperiments, 0.0f, 1000.0f, FIELD(refine.prior_weight),
             "weight of the mask before it"),
      flag("views.hidden_test", kExperiments, FIELD(hidden_test),
           "views in which something hides the object are taken from nearer or left out"),
      number("views.distance_sizes", kExperiments, 0.5f, 10.0f, FIELD(orbit.distance_sizes),
             "distance of the orbit over the object's size"),
      number("views.settled", kExperiments, 1, 400, FIELD(settled_views),
             "in how many views running the labels must not change"),
      number("views.agreement", kExperiments, 0.0, 1.0, FIELD(view_agreement),
             "views whose mask agrees less with the cutout are left out"),
      number("least_object_px", kExperiments, 0, 4096, FIELD(least_object_px),
             "square root of its pixels: smaller objects are looked at with more"),
      flag("pick.join_enclosed", kExperiments, FIELD(join_enclosed),
           "hidden pieces that touch the object alone belong to it"),
      number(
          "prior_px_per_view", kExperiments, 0.0f, 1000.0f, FIELD(prior_px_per_view),
          "what the parts say counts as that many pixels of each Gaussian; nothing where --masks are given"),
  };
}

#undef FIELD

const Setting& found(std::string_view name) {
  const auto it = std::ranges::find(settings_table(), name, &Setting::name);
  if (it != settings_table().end()) return *it;
  std::vector<std::string> names;
  for (const Setting& setting : settings_table()) names.push_back(setting.name);
  throw Error(fmt::format("setting \"{}\"", name), "there is no such setting",
              fmt::format("Take NAME=VALUE with one of {}", fmt::join(names, ", ")));
}

}  // namespace

std::span<const Setting> settings_table() {
  static const std::vector<Setting> table = make_table();
  return table;
}

void set_setting(std::string_view name, std::string_view value, CutSettings* settings) {
  const Setting& setting = found(name);
  if (!setting.set(value, settings))
    throw Error(setting.name, fmt::format("\"{}\" is no value for it", value), "It takes " + setting.values);
}

void set_setting(std::string_view assignment, CutSettings* settings) {
  const std::size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string_view value = assignment.substr(std::min(equals + 1, assignment.size()));
  set_setting(assignment.substr(0, equals), value, settings);
}

void check(const CutSettings& settings) {
  for (const Setting& setting : settings_table()) {
    CutSettings copy;
    set_setting(setting.name, setting.get(settings), &copy);
  }
  if (settings.parts_only && settings.first_mask_from != FirstMaskFrom::kParts)
    throw Error("parts_only", "the parts cannot be the answer where the first mask comes from pixels",
                "Leave one of the two out");
}

std::vector<std::string> differences(const CutSettings& settings, const CutSettings& from) {
  std::vector<std::string> assignments;
  for (const Setting& setting : settings_table())
    if (setting.get(settings) != setting.get(from))
      assignments.push_back(setting.name + "=" + setting.get(settings));
  return assignments;
}

std::string settings_help() {
  std::string help;
  for (const Setting& setting : settings_table())
    if (setting.whom == SettingFor::kPeople)
      help += fmt::format("  {:<29} {}: {}\n", setting.name, setting.values, setting.sentence);
  return help;
}

}  // namespace splatcut
