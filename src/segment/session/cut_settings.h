// How an object is cut out, whatever was said about it.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "segment/graphcut/cut.h"
#include "segment/masks/enclosed.h"
#include "segment/masks/first_mask.h"
#include "segment/masks/propagate.h"
#include "segment/masks/refine_mask.h"
#include "segment/masks/trim.h"
#include "segment/superpoints/orbit.h"
#include "segment/superpoints/prepared_scene.h"

namespace splatcut {

// Where the mask of the reference view comes from.
enum class FirstMaskFrom {
  kParts,   // the hierarchy of parts: all views at once
  kPixels,  // geodesic distance and GrabCut in the one picture
};

// No views around the object after clicks, which parts answer in all views at once: on the bank of
// docs/clicks.md they cost three times the time and gained nothing. kViewsAround where a mask or pixels say
// what is meant.
inline constexpr int kViewsAsNeeded = -1;

// As they stand here: the default preset. By name, with ranges and a sentence each: settings_table.h.
struct CutSettings {
  int work_width_px = 320;  // views are rendered no wider than this
  OrbitOptions orbit{.views = kViewsAsNeeded};
  int neighbours = 10;  // k of the graph
  FirstMaskFrom first_mask_from = FirstMaskFrom::kParts;
  FirstMaskOptions first_mask;  // kPixels, and strokes in other views
  float prior_px_per_view = 3;  // kParts: what the parts say counts as that many pixels of each Gaussian
  bool join_enclosed = true;    // kParts: hidden pieces that touch the object alone belong to it
  EnclosedOptions enclosed;
  bool parts_only = false;   // kParts: they are the answer: no other views, no graph cut
  bool hard_counts = false;  // the likelihood counts pixels, not weights (the paper's hard variant)
  Propagator propagate = Propagator::kLift;
  // Of propagated masks. The picture may add what the parts missed: a mask too small is the worse mistake
  // (docs/masks.md).
  RefineOptions refine{.solver = MaskSolver::kPixelCut, .grow_px = 4};
  bool hidden_test = true;  // views in which something hides the object are taken from nearer or left out
  double settled_change = 0.003;  // no more views once the labels change by less (share of the object) ...
  int settled_views = 2;          // ... in that many views running
  int least_object_px = 48;       // square root of its pixels: smaller ones are looked at with more pixels
  double view_agreement = 0.6;    // views whose mask agrees less with the solution are left out
  CutOptions cut;
  // Weight of the neighbour term in the last cut alone, [0, 500]; that of all the others where not given. The
  // views are then looked at once, however often it is changed.
  std::optional<float> smoothness;
  bool trim = true;  // see trim.h
  TrimOptions trim_options;

  float last_lambda() const { return smoothness.value_or(cut.energy.lambda); }
  bool operator==(const CutSettings&) const = default;
};

// Settings under a name, for people.
struct Preset {
  const char *name, *title, *sentence;
  CutSettings (*settings)();
};
std::span<const Preset> presets();  // the first for daily work, the others for comparison with the paper

// By name. Throws Error that lists them for any other name.
CutSettings preset(const std::string& name);

// "default, paper or paper-code".
std::string preset_names();

// Throws Error with name, value and range for settings out of range, or that contradict each other.
void check(const CutSettings& settings);

}  // namespace splatcut
