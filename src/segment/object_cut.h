// From one object's strokes, in any number of views, to a label per Gaussian: what the window runs after
// every stroke, and what `splatcut cut --work` runs again.
//
// In: cloud with its solvers, strokes by view (the first view with an object stroke is the reference),
// views to leave out, smoothness. Out: labels (1 = object), the views with their masks, milliseconds per
// stage. Steps: (1) cut_out() from the reference's strokes at the preset's own smoothness; (2) where strokes
// in other views, left-out views or another smoothness ask for it, the masks are corrected and one more cut
// is solved:
//   A_g += k (M_g of added + removed pixels),  M_g += k (M_g of added pixels),  k = 4 x views used,
// so that a stroke in one view outweighs the views that did not see the fault; what the parts say and the
// trimming count as in step 1.
// Step 1 is kept: what changes only step 2 costs only step 2. The result is a function of the input alone,
// kept steps or not, on any number of threads. Errors: Error for an unknown preset. Nothing marked, nothing
// found, cancelled: in `outcome` with a reason.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "segment/pipeline.h"
#include "segment/prepared_scene.h"

namespace splatcut {

class StageClock;

struct StrokedView {
  Camera camera;
  Strokes strokes;  // in the camera's pixels
};

struct ObjectCutInput {
  std::vector<StrokedView> views;
  glm::vec3 up_world{0, -1, 0};
  std::string preset = "default";
  std::optional<float>
      smoothness;             // weight of the neighbour term, [0, 500]; the preset's own where not given
  int part_step = 0;          // see PickOptions::scale_steps
  std::vector<int> left_out;  // indices into ObjectCutReport::views that do not count
};

struct ObjectCutReport {
  Outcome outcome = Outcome::kDone;
  std::string reason;                // for kNothingFound
  std::vector<std::uint8_t> labels;  // per Gaussian, 1 = object
  std::vector<ViewReport> views;     // the reference, orbit views, then the other stroked views
  std::size_t sizes = 0, size = 0;   // that the first click can mean, from small to large; the one taken
  bool ambiguous = false;            // another size was nearly as likely
  std::vector<StageTime> stages;     // what was done this time; kept steps cost nothing and are not listed
};

// The solvers of a scene, for all its objects, one cut at a time: what they know of the graph, and mostly the
// flow, is of use to the next cut, and so are the views drawn last. Labels do not depend on what was done
// before.
class SceneSolvers {
 public:
  SceneSolvers(std::shared_ptr<const GaussianCloud> cloud, std::shared_ptr<const PreparedScene> prepared);

  // As the options want it: with another number of neighbours than was prepared, a graph is made and kept.
  // Cancelled: what is returned must not be used.
  const PreparedScene& prepared(const PipelineOptions& options, const Job& job);
  CutSolver& solver(const PipelineOptions& options, const Job& job);
  void make_ready(const Job& job);  // for the default preset: the first click then waits for less
  KeptViews& views() { return views_; }

 private:
  std::shared_ptr<const GaussianCloud> cloud_;
  std::shared_ptr<const PreparedScene> prepared_;
  std::optional<PreparedScene> other_;  // a graph without parts
  std::optional<CutSolver> solver_, other_solver_;
  KeptViews views_;
};

class ObjectCutter {
 public:
  using Snapshot = std::function<void(const PipelineReport&)>;  // called on the running thread

  ObjectCutter(std::shared_ptr<const GaussianCloud> cloud, std::shared_ptr<SceneSolvers> solvers);

  ObjectCutReport cut(const ObjectCutInput& input, const Snapshot& on_snapshot = {}, const Job& job = {});

  // w_g as the last cut of `input` weighed it, for display: soft or hard, with corrections and what the parts
  // say. Cancelled, or nothing marked: unspecified.
  std::vector<float> likelihood_of(const ObjectCutInput& input, const Job& job = {});

 private:
  const PipelineReport& first_cut(const ObjectCutInput& input, const StrokedView& reference,
                                  const Snapshot& on_snapshot, const Job& job, bool* fresh);
  bool add_up_views(const ObjectCutReport& out, const PipelineOptions& settings, StageClock* clock,
                    const Job& job);
  Likelihood evidence(const ObjectCutInput& input, const PipelineReport& first,
                      const PipelineOptions& settings, StageClock* clock, const Job& job,
                      ObjectCutReport* out);

  std::shared_ptr<const GaussianCloud> cloud_;
  std::shared_ptr<SceneSolvers> solvers_;
  std::string first_key_;                // inputs of step 1 as bytes
  std::optional<PipelineReport> first_;  // its result
  std::string sums_key_;                 // masks that sums_ was added up from
  std::optional<MaskedSums> sums_;
};

// The inputs as bytes: equal exactly where the result must be. For keys, not for files.
std::string key_of(const ObjectCutInput& input);

}  // namespace splatcut
