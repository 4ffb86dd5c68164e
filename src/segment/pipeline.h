// From a scene and strokes in one view to a label per Gaussian: the stages "first mask" to "trim" of
// ARCHITECTURE.md.
//
// In: cloud, reference camera, strokes in the reference's pixels (or a mask of it).
// Out: labels (1 = object), the views used with their masks, likelihood, energy, milliseconds per stage.
// Source: Jain et al., GaussianCut, NeurIPS 2024; the propagator is ours: labels of a 3D cut rendered into
// the next view are its mask. Views are added until the labels stop changing.
// Errors: Error for strokes that mark nothing. Expected outcomes (nothing found, cancelled) are in `outcome`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/gaussian_cloud.h"
#include "scene/image.h"
#include "scene/job.h"
#include "segment/cut.h"
#include "segment/enclosed.h"
#include "segment/first_mask.h"
#include "segment/orbit.h"
#include "segment/part_picker.h"
#include "segment/prepared_scene.h"
#include "segment/propagate.h"
#include "segment/refine_mask.h"
#include "segment/seeds.h"
#include "segment/trim.h"

namespace splatcut {

// Gives the mask of a view in place of the pipeline's own (truth in experiments, masks of other tools).
using MaskSource = std::function<Mask(const Camera&)>;

// A view whose mask the user brings. Mask: any size of the camera's aspect ratio.
struct GivenView {
  Camera camera;
  Mask mask;
};

// Where the mask of the reference view comes from.
enum class FirstMaskFrom {
  kParts,   // the hierarchy of parts: all views at once
  kPixels,  // geodesic distance and GrabCut in the one picture, corrected by a first cut in 3D
};

struct PipelineReport;

struct PipelineOptions {
  int work_width_px = 320;  // views are rendered no wider than this
  OrbitOptions orbit;
  std::vector<Camera> view_cameras;   // empty: see cameras_around()
  std::vector<Camera> scene_cameras;  // of its photographs, where known
  int neighbours = 10;                // k of the graph
  PreparedCache cache;                // where the scene is not prepared yet
  FirstMaskFrom first_mask_from = FirstMaskFrom::kParts;
  PickOptions pick;                // kParts
  FirstMaskOptions first_mask;     // kPixels
  bool feedback = true;            // kPixels: cut from the one view in 3D, rendered back, corrects the mask
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
  bool trim = true;  // see trim.h
  TrimOptions trim_options;
  std::optional<Mask> given_first_mask;  // size of the reference camera
  MaskSource given_masks;                // of every orbit view
  std::vector<GivenView> given_views;    // these in place of an orbit
  // Called on the running thread when a mask was found and after each cut; the report is as far as it has
  // come.
  std::function<void(const PipelineReport&)> on_snapshot;
};

// Settings by name: fast (the first view alone), default, best, paper (GaussianCut's literal energy and
// counts), paper-code (those of its published code). Throws Error for any other name.
PipelineOptions preset(const std::string& name);

// What a scene must be prepared with for these options.
PrepareOptions prepare_options(const PipelineOptions& options);

struct ViewReport {
  Camera camera;
  Mask mask;
  bool used = false;
  double confidence = 0;   // IoU of the mask and the final labels seen in this view
  std::string reason;      // why it was left out
  bool disagreed = false;  // left out because its mask disagrees with the others
};

enum class Outcome { kDone, kNothingFound, kCancelled };

struct PipelineReport {
  Outcome outcome = Outcome::kDone;
  std::string reason;                // for kNothingFound
  std::vector<std::uint8_t> labels;  // per Gaussian of the cloud, 1 = object
  std::vector<std::uint8_t> prior;   // kParts: what the parts say, per Gaussian; it counts in every cut
  CutReport cut;
  std::size_t first_sizes = 0, first_size = 0;  // kParts: sizes that the first click can mean; the one taken
  bool ambiguous = false;                       // kParts: another size was nearly as likely
  std::size_t trimmed = 0;                      // Gaussians that left the object after the cut
  std::vector<ViewReport> views;                // the reference first
  std::string enough;                           // why there are no more views
  std::vector<StageTime> stages;                // in order, same names added up
};

// What was enough: views that count, and their pixels.
struct LookedAt {
  int views = 0;
  std::size_t pixels = 0;
  double pixels_per_view() const { return views ? static_cast<double>(pixels) / views : 0; }
};
LookedAt looked_at(const std::vector<ViewReport>& views);

// trim() by the views that count. Returns how many Gaussians left the object.
std::size_t trim_to_views(const Drawer& drawer, const std::vector<ViewReport>& views,
                          const PipelineOptions& options, std::vector<std::uint8_t>* labels,
                          const Job& job = {});

// `prepared` may be null: it is then made here. up_world: which way is up, for the orbit. solver: of this
// cloud and the prepared graph, with options.cut, used in place of a fresh one; the labels are the same.
// kept: views to draw by, else its own. Throws Error for parts as the answer (cut_parts = false) without
// parts (kPixels).
PipelineReport cut_out(const GaussianCloud& cloud, const PreparedScene* prepared, const Camera& reference,
                       const glm::vec3& up_world, const Strokes& strokes, const PipelineOptions& options,
                       const Job& job = {}, CutSolver* solver = nullptr, KeptViews* kept = nullptr);

// What a program that waits for strokes has ready: a solver whose arcs are weighed, and OpenCV's tables.
CutSolver ready_solver(const GaussianCloud& cloud, const PreparedScene& prepared,
                       const PipelineOptions& options);

// The first mask alone (after feedback), in the size of limited_to_width(reference, work_width_px).
Mask first_mask_of(const GaussianCloud& cloud, const PreparedScene& prepared, const Camera& reference,
                   const Strokes& strokes, const PipelineOptions& options, const Job& job = {},
                   KeptViews* kept = nullptr);

}  // namespace splatcut
