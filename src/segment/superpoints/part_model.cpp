#include "segment/superpoints/part_model.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <type_traits>
#include <vector>

namespace splatcut {

namespace {

template <class Field>
PartWeight weight(std::string name, bool prepared, Field field) {
  return {std::move(name), prepared, [=](const PartModel& m) { return static_cast<double>(field(m)); },
          [=](PartModel* m, double value) {
            auto& of = field(*m);
            of = static_cast<std::remove_reference_t<decltype(of)>>(value);
          }};
}

#define WEIGHT(name, member, prepared) \
  weight(                              \
      #name, prepared, [](auto& m) -> auto& { return m.member; })

struct TermWeight {
  Term term;
  float weight;
};

// The rest is 0.
TermValues weights(std::initializer_list<TermWeight> given) {
  TermValues all{};
  for (const TermWeight& w : given) all[static_cast<std::size_t>(w.term)] = w.weight;
  return all;
}

std::vector<PartWeight> term_weights(const std::string& of, TermValues SelectionModel::*values) {
  std::vector<PartWeight> table;
  for (std::size_t t = 0; t < kTerms; ++t)
    table.push_back(
        {"selection." + of + "." + term_names()[t], false,
         [=](const PartModel& m) { return static_cast<double>((m.selection.*values)[t]); },
         [=](PartModel* m, double value) { (m->selection.*values)[t] = static_cast<float>(value); }});
  return table;
}

std::vector<PartWeight> make_table() {
  std::vector<PartWeight> table = {
      WEIGHT(surface.neighbours, parts.surface.neighbours, true),
      WEIGHT(surface.least_opacity, parts.surface.least_opacity, true),
      WEIGHT(surface.size_quantile, parts.surface.size_quantile, true),
      WEIGHT(surface.least_seen_px, parts.surface.least_seen_px, true),
      WEIGHT(surface.normal_rounds, parts.surface.normal_rounds, true),
      WEIGHT(surface.colour_rounds, parts.surface.colour_rounds, true),
      WEIGHT(surface.like_colour, parts.surface.like_colour, true),
      WEIGHT(superpoints.k, parts.superpoints.k, true),
      WEIGHT(superpoints.cap, parts.superpoints.cap, true),
      WEIGHT(superpoints.least, parts.superpoints.least, true),
      WEIGHT(superpoints.colour_unit, parts.superpoints.colour_unit, true),
      WEIGHT(superpoints.normal, parts.superpoints.normal, true),
      WEIGHT(superpoints.concavity, parts.superpoints.concavity, true),
      WEIGHT(superpoints.gap, parts.superpoints.gap, true),
      WEIGHT(superpoints.gap_most, parts.superpoints.gap_most, true),
      WEIGHT(superpoints.gap_unit, parts.superpoints.gap_unit, true),
      WEIGHT(superpoints.distance, parts.superpoints.distance, true),
      WEIGHT(merging.base, parts.merging.base, true),
      WEIGHT(merging.border_colour, parts.merging.border_colour, true),
      WEIGHT(merging.region_colour, parts.merging.region_colour, true),
      WEIGHT(merging.concavity, parts.merging.concavity, true),
      WEIGHT(merging.convexity, parts.merging.convexity, true),
      WEIGHT(merging.normal, parts.merging.normal, true),
      WEIGHT(merging.gap, parts.merging.gap, true),
      WEIGHT(merging.area_power, parts.merging.area_power, true),
      WEIGHT(merging.border_power, parts.merging.border_power, true),
      WEIGHT(merging.gap_most, parts.merging.gap_most, true),
      WEIGHT(merging.gap_unit, parts.merging.gap_unit, true),
      WEIGHT(merging.cut_scale, parts.merging.cut_scale, true),
      WEIGHT(parts.trees, parts.trees, true),
      WEIGHT(parts.shade_blind_trees, parts.shade_blind_trees, true),
      WEIGHT(parts.lightness, parts.lightness, true),
      WEIGHT(parts.jitter, parts.jitter, true),
      WEIGHT(parts.noise, parts.noise, true),
      WEIGHT(parts.votes, parts.votes, true),
      WEIGHT(selection.disc_share, selection.disc_share, false),
      WEIGHT(selection.disc_majority, selection.disc_majority, false),
      WEIGHT(selection.least_visible, selection.least_visible, false),
      WEIGHT(selection.nearer_majority, selection.nearer_majority, false),
      WEIGHT(selection.offered, selection.offered, false),
      WEIGHT(of_mask.tolerance, of_mask.tolerance, false),
      WEIGHT(of_mask.least_visible, of_mask.least_visible, false),
  };
  std::ranges::move(term_weights("first", &SelectionModel::first), std::back_inserter(table));
  std::ranges::move(term_weights("later", &SelectionModel::later), std::back_inserter(table));
  std::ranges::move(term_weights("box", &SelectionModel::box), std::back_inserter(table));
  return table;
}

#undef WEIGHT

}  // namespace

SelectionModel::SelectionModel()
    : first(weights({{Term::kCut, 0.35f},
                     {Term::kRare, 1.9f},
                     {Term::kFrame, 1.4f},
                     {Term::kShadeBlind, -3.2f},
                     {Term::kOffCentre, 1.8f},
                     {Term::kNoEdge, 10.1f},
                     {Term::kCropped, 4.2f},
                     {Term::kSmall, 1.1f},
                     {Term::kLarge, 3.3f}})),
      later(weights({{Term::kCut, 0.1f},    {Term::kJump, -0.1f},      {Term::kRare, 3},
                     {Term::kFrame, 1.9f},  {Term::kShadeBlind, 0.5f}, {Term::kOffCentre, 2},
                     {Term::kScrap, 0.5f},  {Term::kApart, 1},         {Term::kFold, 1},
                     {Term::kGiant, 3.25f}, {Term::kBorder, 3.25f},    {Term::kHidden, 2},
                     {Term::kTakes, 1.5f},  {Term::kOpposed, 5},       {Term::kBack, 1},
                     {Term::kAgain, -3},    {Term::kDisc, 1},          {Term::kRepick, -2},
                     {Term::kAgreed, -2},   {Term::kDoubtful, 16},     {Term::kDearer, 1}})),
      box(weights({{Term::kCut, 0.1f},
                   {Term::kFrame, 0.2f},
                   {Term::kNoEdge, 1.5f},
                   {Term::kCropped, 0.6f},
                   {Term::kSmall, 0.2f},
                   {Term::kLarge, 0.5f},
                   {Term::kShort, 3},
                   {Term::kSpill, 4},
                   {Term::kFills, 0.7f}})) {}

std::span<const std::string> term_names() {
  static const std::array<std::string, kTerms> names = {
      "cut",     "jump",   "rare",     "frame",   "shade_blind", "off_centre", "no_edge",
      "cropped", "small",  "large",    "scrap",   "apart",       "fold",       "giant",
      "border",  "hidden", "takes",    "opposed", "back",        "again",      "disc",
      "repick",  "agreed", "doubtful", "dearer",  "short",       "spill",      "fills"};
  return names;
}

std::span<const PartWeight> part_weights() {
  static const std::vector<PartWeight> table = make_table();
  return table;
}

}  // namespace splatcut
