// The fitted model of parts: every weight of surface, superpoints, merging and picking that a search has set.
//
// Where the values come from: searches on the captures and compositions of docs/masks.md and on still lifes,
// for the mean IoU of a robot's first clicks; figures on those scenes are not held out. Version 2: the costs
// of a first click by gradient of the expected IoU of the chosen part, on photos.json, real.json and the
// composed scenes (.80 fitted, .77 with each scene left out); those of corrections by hand on them. The
// program of that search is not part of the project yet: it cannot be repeated. Nobody knows a value by
// reason, so none is a setting: a person sees none of them, experiments give a whole model (see
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
  int shade_blind_trees = 3;  // further trees in which lightness counts less than hue:
  float lightness = 0.35f;    // its weight there
  float jitter = 0.3f;        // spread of the logarithms of the weights from tree to tree; the first has none
  float noise = 0.1f;         // of the logarithm of each cost, in all trees but the first
  int votes = 10;             // neighbours that vote where a Gaussian outside of the core belongs
};

// What a click means: costs of its candidates, logarithms of folds unless said otherwise; see
// selection/click_selection.h.
struct SelectionModel {
  float cut_weight = 0.1f;
  float jump_weight = 0.1f;
  float first_stability_weight = 10, stability_weight = 3;
  float first_frame_weight = 0.44f, frame_weight = 1.9f;
  float first_shade_blind_cost = 0,
        shade_blind_cost = 0.5f;  // of candidates from trees that count lightness less

  float first_centre_weight = 1, first_centre_slack = 0.7f;
  float small_weight = 2.9f, small_share = 0.01f;   // share of the picture's pixels below which it costs
  float large_weight = 0.66f, large_share = 0.35f;  // and above which

  float centre_weight = 2, centre_slack = 0.7f;
  float scrap_weight = 1.5f, scrap_folds = -0.3f;   // ln(changed pixels / disc) below which it costs
  float fold_weight = 0.15f, fold_slack = 1;        // above which it costs,
  float giant_weight = 3.25f, giant_folds = 3.25f;  // and costs more
  float border_px = 2,
        border_folds = 1;  // the latter in place of giant_folds for clicks nearer to the border
  float opposed_cost = 5;  // per click of the other sign
  float disc_cost = 4;     // of changing the disc alone
  float back_weight = 1;   // times the IoU with what a click of the other sign has changed
  float repick_cost = 0;   // of another part for the first click, see below

  float disc_share = 0.7f;       // of the distance to the displayed border that is certain
  float disc_majority = 0.5f;    // of a leaf's or Gaussian's pixels that must lie in the disc
  float least_visible = 0.3f;    // share of a leaf that the view must show for the disc to decide it
  float nearer_majority = 0.7f;  // of trees, for a leaf to follow a correction
  float doubt = 0.25f;           // how much likelier the first click's part must be to count as clear

  bool operator==(const SelectionModel&) const = default;
};

// What a mask means: see part_view.h.
struct MaskToPartsOptions {
  float tolerance = 0.15f;      // pixels that a whole node may lose against its children, share of its own
  float least_visible = 0.05f;  // share of a node's area in leaves that the view shows
};

struct PartModel {
  static constexpr int kVersion = 2;
  PartOptions parts;
  SelectionModel selection;
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
