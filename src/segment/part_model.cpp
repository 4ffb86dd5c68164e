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
      WEIGHT(parts.jitter, parts.jitter, true),
      WEIGHT(parts.noise, parts.noise, true),
      WEIGHT(parts.votes, parts.votes, true),
      WEIGHT(pick.doubt, pick.doubt, false),
      WEIGHT(pick.stability_weight, pick.stability_weight, false),
      WEIGHT(pick.rise_bonus, pick.rise_bonus, false),
      WEIGHT(pick.cut_weight, pick.cut_weight, false),
      WEIGHT(pick.jump_bonus, pick.jump_bonus, false),
      WEIGHT(pick.root_penalty, pick.root_penalty, false),
      WEIGHT(pick.frame_penalty, pick.frame_penalty, false),
      WEIGHT(pick.small_share, pick.small_share, false),
      WEIGHT(pick.large_share, pick.large_share, false),
      WEIGHT(pick.small_penalty, pick.small_penalty, false),
      WEIGHT(pick.large_penalty, pick.large_penalty, false),
      WEIGHT(pick.least_log_cut, pick.least_log_cut, false),
      WEIGHT(pick.growth_penalty, pick.growth_penalty, false),
      WEIGHT(pick.growth_slack, pick.growth_slack, false),
      WEIGHT(pick.late_growth_penalty, pick.late_growth_penalty, false),
      WEIGHT(pick.late_growth_slack, pick.late_growth_slack, false),
      WEIGHT(pick.change_small, pick.change_small, false),
      WEIGHT(pick.change_large, pick.change_large, false),
      WEIGHT(pick.change_slack, pick.change_slack, false),
      WEIGHT(pick.change_most, pick.change_most, false),
      WEIGHT(pick.change_most_of_selected, pick.change_most_of_selected, false),
      WEIGHT(pick.rest_most_of_selected, pick.rest_most_of_selected, false),
      WEIGHT(pick.border_px, pick.border_px, false),
      WEIGHT(pick.joint_bonus, pick.joint_bonus, false),
      WEIGHT(pick.hidden_penalty, pick.hidden_penalty, false),
      WEIGHT(pick.hidden_slack, pick.hidden_slack, false),
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
