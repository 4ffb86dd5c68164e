// How an object is cut out, whatever was said about it.
#pragma once

#include <string>

#include "segment/cut.h"
#include "segment/enclosed.h"
#include "segment/first_mask.h"
#include "segment/orbit.h"
#include "segment/part_picker.h"
#include "segment/prepared_scene.h"
#include "segment/propagate.h"
#include "segment/refine_mask.h"
#include "segment/trim.h"

namespace splatcut {

// Where the mask of the reference view comes from.
enum class FirstMaskFrom {
  kParts,   // the hierarchy of parts: all views at once
  kPixels,  // geodesic distance and GrabCut in the one picture
};

struct CutSettings {
  int work_width_px = 320;  // views are rendered no wider than this
  OrbitOptions orbit;
  int neighbours = 10;  // k of the graph
  FirstMaskFrom first_mask_from = FirstMaskFrom::kParts;
  PickOptions pick;                // kParts
  FirstMaskOptions first_mask;     // kPixels, and strokes in other views
  float prior_px_per_view = 0.1f;  // kParts: what the parts say counts as that many pixels of each Gaussian
  bool join_enclosed = true;       // kParts: hidden pieces that touch the object alone belong to it
  EnclosedOptions enclosed;
  bool cut_parts = true;     // kParts: the graph cut settles what the parts say; false: they are the answer
  bool hard_counts = false;  // the likelihood counts pixels, not weights (the paper's hard variant)
  Propagator propagate = Propagator::kLift;
  RefineOptions refine{.solver = MaskSolver::kNone};  // of propagated masks: thin parts suffer from it
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

  bool operator==(const CutSettings&) const = default;
};

// Settings by name: fast (the first view alone), default, best, paper (GaussianCut's literal energy and
// counts), paper-code (those of its published code). Throws Error for any other name.
CutSettings preset(const std::string& name);

// Throws Error for settings that contradict each other.
void check(const CutSettings& settings);

// What a scene must be prepared with for these settings.
PrepareOptions prepare_options(const CutSettings& settings, const PreparedCache& cache = {});

}  // namespace splatcut
