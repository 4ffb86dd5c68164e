#include "segment/part_model.h"

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

std::vector<PartWeight> make_table() {
  return {
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
      WEIGHT(selection.cut_weight, selection.cut_weight, false),
      WEIGHT(selection.jump_weight, selection.jump_weight, false),
      WEIGHT(selection.first_stability_weight, selection.first_stability_weight, false),
      WEIGHT(selection.stability_weight, selection.stability_weight, false),
      WEIGHT(selection.first_frame_weight, selection.first_frame_weight, false),
      WEIGHT(selection.frame_weight, selection.frame_weight, false),
      WEIGHT(selection.first_shade_blind_cost, selection.first_shade_blind_cost, false),
      WEIGHT(selection.shade_blind_cost, selection.shade_blind_cost, false),
      WEIGHT(selection.first_centre_weight, selection.first_centre_weight, false),
      WEIGHT(selection.first_centre_slack, selection.first_centre_slack, false),
      WEIGHT(selection.small_weight, selection.small_weight, false),
      WEIGHT(selection.small_share, selection.small_share, false),
      WEIGHT(selection.large_weight, selection.large_weight, false),
      WEIGHT(selection.large_share, selection.large_share, false),
      WEIGHT(selection.centre_weight, selection.centre_weight, false),
      WEIGHT(selection.centre_slack, selection.centre_slack, false),
      WEIGHT(selection.scrap_weight, selection.scrap_weight, false),
      WEIGHT(selection.scrap_folds, selection.scrap_folds, false),
      WEIGHT(selection.fold_weight, selection.fold_weight, false),
      WEIGHT(selection.fold_slack, selection.fold_slack, false),
      WEIGHT(selection.giant_weight, selection.giant_weight, false),
      WEIGHT(selection.giant_folds, selection.giant_folds, false),
      WEIGHT(selection.border_px, selection.border_px, false),
      WEIGHT(selection.border_folds, selection.border_folds, false),
      WEIGHT(selection.opposed_cost, selection.opposed_cost, false),
      WEIGHT(selection.disc_cost, selection.disc_cost, false),
      WEIGHT(selection.back_weight, selection.back_weight, false),
      WEIGHT(selection.repick_cost, selection.repick_cost, false),
      WEIGHT(selection.disc_share, selection.disc_share, false),
      WEIGHT(selection.disc_majority, selection.disc_majority, false),
      WEIGHT(selection.least_visible, selection.least_visible, false),
      WEIGHT(selection.nearer_majority, selection.nearer_majority, false),
      WEIGHT(selection.doubt, selection.doubt, false),
      WEIGHT(of_mask.tolerance, of_mask.tolerance, false),
      WEIGHT(of_mask.least_visible, of_mask.least_visible, false),
  };
}

#undef WEIGHT

}  // namespace

std::span<const PartWeight> part_weights() {
  static const std::vector<PartWeight> table = make_table();
  return table;
}

}  // namespace splatcut
