// The fitted model of parts: every weight of surface, superpoints, merging and picking that a search has set.
//
// Where the values come from: searches on the captures and compositions of docs/masks.md and on still lifes,
// for the mean IoU of a robot's first clicks; figures on those scenes are not held out. Nobody knows a value
// by reason, so none is a setting: a person sees none of them, experiments give a whole model (see
// app/lab/part_model_file.h). Whoever changes a value raises kVersion and says here what was searched on
// what.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace splatcut {

// Which Gaussians are surface, and how its normals and colours are smoothed: see surface_features.h.
struct SurfaceOptions {
  int neighbours = 10;
  float least_opacity = 0.1f;
  float size_quantile = 0.985f;  // Gaussians whose largest sigma lies above are no core
  float least_seen_px = 0.02f;   // A_g summed over the observing views
  int normal_rounds = 3, colour_rounds = 3;
  float like_colour = 0.1f;  // sigma of the bilateral weight, RGB in [0, 1]
};

// Leaves of the hierarchy: see part_hierarchy.h.
struct SuperpointOptions {
  float k = 3.2f;           // larger: larger superpoints
  std::uint32_t cap = 40;   // most core Gaussians in one
  std::uint32_t least = 2;  // smaller ones join their likest neighbour
  // Dissimilarity of two neighbours: |dc| / colour_unit + normal (1 - n.n') + concavity max(0, concavity) +
  // gap min(gap_most, gap_unit gap) + distance d / spacing.
  float colour_unit = 0.1f, normal = 0.6f, concavity = 1;
  float gap = 0.3f, gap_most = 3, gap_unit = 0.3f;
  float distance = 0.1f;
};

// Unions of parts, least different first: see part_hierarchy.h.
struct MergingOptions {
  float base = 0.04f;
  float border_colour = 5;
  float region_colour = 3.9f;
  float concavity = 2;
  float convexity = 0.3f;
  float normal = 0.3f;
  float gap = 0.14f;
  float area_power = 0.3f;
  float border_power = 0.33f;
  float gap_most = 3, gap_unit = 0.3f;  // gaps count as min(gap_most, gap_unit gap)
  float cut_scale = 0.23f;
};

struct PartOptions {
  SurfaceOptions surface;
  SuperpointOptions superpoints;
  MergingOptions merging;
  int trees = 5;
  float jitter = 0.3f;  // spread of the logarithms of the weights from tree to tree; the first has none
  float noise = 0.1f;   // of the logarithm of each cost, in all trees but the first
  int votes = 10;       // neighbours that vote where a Gaussian outside of the core belongs
};

// What a click means: see part_picker.h.
struct PickModel {
  float doubt = 0.25f;  // how much more likely the first click's part must be than others to count as clear
  float stability_weight = 3;  // of -ln of the mean IoU with the other trees' likest parts

  // Logarithms of folds unless said otherwise; found by random search (docs/masks.md).
  float rise_bonus = 0.0095f;
  float cut_weight = 0.094f, jump_bonus = 0.17f, root_penalty = 0.011f;
  float frame_penalty = 1.9f;
  float small_share = 0.01f, large_share = 0.35f;  // of the picture's pixels
  float small_penalty = 2, large_penalty = 0.55f;
  float least_log_cut = -16;
  float growth_penalty = 0.01f, growth_slack = 0.5f;         // of additions larger than what is selected
  float late_growth_penalty = 1, late_growth_slack = 0.69f;  // the same from the third object click on
  float change_small =
      0.2f;  // of later clicks that change less than a disc which reaches from the click to the border
  float change_large = 3.4f, change_slack = 3.25f, change_most = 2.7f;  // of later clicks
  float change_most_of_selected =
      1;  // an object click farther than border_px from the selection may add that much
  float rest_most_of_selected = 0.25f;  // and a rest click may remove that much
  float border_px = 2;                  // nearer ones mend its border
  float joint_bonus = 1;                // of later object clicks, for a part that holds all of them
  float hidden_penalty = 1,
        hidden_slack = 2;  // of later clicks that bring much of what the view hides, per pixel
  bool operator==(const PickModel&) const = default;
};

// What a mask means: see part_picker.h.
struct MaskToPartsOptions {
  float tolerance = 0.15f;      // pixels that a whole node may lose against its children, share of its own
  float least_visible = 0.05f;  // share of a node's area in leaves that the view shows
};

struct PartModel {
  static constexpr int kVersion = 1;
  PartOptions parts;
  PickModel pick;
  MaskToPartsOptions of_mask;
};

struct PartWeight {
  std::string name;
  bool prepared;  // the hierarchy depends on it, not only what a click or a mask means
  std::function<double(const PartModel&)> get;
  std::function<void(PartModel*, double)> set;
};

// All weights, a line of the table in the .cpp file each.
std::span<const PartWeight> part_weights();

}  // namespace splatcut
