// The fitted model of parts: every weight of surface, superpoints, merging and picking that a search has set.
//
// The values of surface, superpoints and merging come from searches on the captures and compositions of
// docs/masks.md and on still lifes, for the mean IoU of a robot's first clicks. No value follows from theory,
// so none is a setting: experiments replace the whole model (see app/lab/part_model_file.h).
#pragma once

#include <array>
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

// Terms of the cost of what a click or a box can mean: see selection/candidates.h, selection/box_meanings.h.
enum class Term {
  kCut,
  kJump,
  kRare,
  kFrame,
  kShadeBlind,
  kOffCentre,
  kNoEdge,  // this and the next three: of first clicks alone
  kCropped,
  kSmall,
  kLarge,
  kScrap,  // this and those after it: of corrections alone
  kApart,
  kFold,
  kGiant,
  kBorder,
  kHidden,
  kTakes,
  kOpposed,
  kBack,
  kAgain,
  kDisc,
  kRepick,
  kAgreed,
  kDoubtful,
  kDearer,
  kShort,  // this and the next two: of boxes alone
  kSpill,
  kFills
};
inline constexpr std::size_t kTerms = 28;
using TermValues = std::array<float, kTerms>;  // by Term
inline float& weight(TermValues* of, Term term) {
  return (*of)[static_cast<std::size_t>(term)];
}

inline float weight(const TermValues& of, Term term) {
  return of[static_cast<std::size_t>(term)];
}

// As in the table of weights, by Term.
std::span<const std::string> term_names();

// What a click means.
struct SelectionModel {
  TermValues first, later, box;  // weights of the terms: of first clicks, of corrections, of boxes
  float disc_share = 0.5f;       // of the distance to where the clicked region may end that is certain
  float disc_majority = 0.5f;    // of a leaf's or Gaussian's pixels that must lie in the disc
  float least_visible = 0.3f;    // share of a leaf that the view must show for the disc to decide it
  float nearer_majority = 0.5f;  // of trees, for a leaf to follow a correction
  float offered = 4;             // ln 55: what is at least a 55th as likely as the likeliest is offered

  SelectionModel();
  bool operator==(const SelectionModel&) const = default;
};

// What a mask means: see part_view.h.
struct MaskToPartsOptions {
  float tolerance = 0.15f;      // pixels that a whole node may lose against its children, share of its own
  float least_visible = 0.05f;  // share of a node's area in leaves that the view shows
};

struct PartModel {
  // Whoever changes a value raises the version and says here what was searched on what.
  // Version 21: a click on the rest leaves what lies apart and looks like the object
  // (selection/reached_leaves.h); the limit of looks is set by hand (docs/clicks.md, "Within reach").
  //
  // Version 20: Term::kAgain counts less where the click does not reach most of what would change; the half
  // is not searched (docs/clicks.md, "Once more").
  //
  // Version 19: what the trees disagree about after a first click is settled by colour
  // (selection/settled_by_colour.h), without a weight that was searched.
  //
  // Version 18: from the second correction on, a click on the object pays for what would make it much larger,
  // with the weight of Term::kTakes; all that could win by kOffCentre is looked at (docs/clicks.md).
  //
  // Version 17: clicks on the object, and all after a box, may say that what was said first meant another
  // part, with a weight set by hand; colour must stand out more than before to come first in a box, as
  // searched on 260 boxes (docs/clicks.md).
  //
  // Version 16: a correction after one of the same sign mostly means what holds both; the weight of
  // Term::kAgain is set by hand (docs/clicks.md, "Once more").
  //
  // Version 15: what colour says of a box comes before what the trees agree on where it stands out more
  // (selection/box_by_colour.h).
  //
  // Version 14: doubt costs as much where what would change is small (docs/clicks.md).
  //
  // Version 13: what doubt costs where a rest click asks again is 16, 8 before (docs/clicks.md).
  //
  // Version 12: a rest click asks again what the first click meant, however much that changes. Its two
  // weights are set by hand on the scenes of docs/clicks.md ("Choose again").
  //
  // Version 11: other meanings are offered down to a 55th of the likelihood, a half before.
  //
  // Version 10: what boxes mean is set by hand, on the scenes of docs/clicks.md and eleven more.
  // Version 9: what a first click means is fitted by `splatcut-lab fit` on the scenes of docs/clicks.md,
  // which shows the fit without each of the captures; what corrections mean is set by hand on the same
  // scenes, last the cost of a click on the rest that takes nearly all of the object (Term::kTakes).
  static constexpr int kVersion = 21;
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
