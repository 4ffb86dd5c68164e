// Cuts in one prepared neighbourhood, with all that is kept of it between cuts: what Session asks once it
// knows where an object is.
//
// Steps: (1) the cut from the reference view at the settings' own smoothness, see pipeline.h; (2) where
// strokes in other views, views left out or another smoothness ask for it, the masks are corrected and one
// more cut is solved:
//   A_g += k (M_g of added + removed pixels),  M_g += k (M_g of added pixels),  k = 4 x views used,
// so that a stroke in one view outweighs the views that did not see the fault; what the parts say and the
// trimming count as in step 1. With parts, strokes of all views are replayed in step 1 already, as one
// selection (selection/stroke_replay.h): step 2 then holds views left out and smoothness alone.
// Where a request gives masks of several views, n in all, neither parts nor trimming have a say, and v0 and
// the weights of neighbours are those of the settings times min(1, 3/n), but for the paper's presets. Step 1
// is kept, of each stroke: what changes only step 2 costs only step 2, for each of them.
// Step 3, where strokes alone say what is meant, by parts: a correction changes Gaussians to its own side
// only. A Gaussian that the last stroke on the object would take from it, or one on the rest would add, keeps
// the label that it has without this stroke. So the answer to n strokes builds on that to n - 1, which is
// kept or computed first.
// The result is a function of scene, request and settings alone, kept steps or not, whatever was cut before,
// on any number of threads. One call at a time.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/raster/projected_view.h"
#include "segment/selection/stroke_replay.h"
#include "segment/session/cut_request.h"
#include "segment/session/cut_result.h"
#include "segment/session/cut_settings.h"
#include "segment/superpoints/prepared_scene.h"

namespace splatcut {

struct CutScene;

struct LocalScene {
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const PreparedScene> prepared;  // of the cloud, never null
  glm::vec3 up_world{0, -1, 0};                   // for orbits; a request may know better
  Capture capture;
};

class LocalSession {
 public:
  explicit LocalSession(LocalScene scene);

  const LocalScene& scene() const { return scene_; }

  // Throws Error for settings that contradict each other, or parts that the scene was not prepared with.
  // Nothing marked, nothing found, cancelled: in `outcome`, with a reason.
  CutResult cut(const CutRequest& request, const CutSettings& settings, const Job& job = {},
                const OnSnapshot& on_snapshot = {});

  // The reference's mask alone, before any other view is looked at, in the size of
  // limited_to_width(reference, work_width_px) or larger; empty where nothing marks the object.
  Mask first_mask(const CutRequest& request, const CutSettings& settings, const Job& job = {});

  // w_g as the last cut of `request` weighed it, for display: soft or hard, with corrections and what the
  // parts say. Cancelled, or nothing marked: unspecified.
  std::vector<float> likelihood_of(const CutRequest& request, const CutSettings& settings,
                                   const Job& job = {});

  // Labels that the strokes mean by parts alone: what cut() begins with.
  std::vector<std::uint8_t> meant(const CutRequest& request, const CutSettings& settings,
                                  const Job& job = {});

  // True if the last stroke takes the largest of its sizes, or the smallest: a step beyond changes nothing.
  // False where a stroke that was made before the first one on the object is applied last.
  bool at_last_size(const CutRequest& request, const CutSettings& settings, bool larger, const Job& job = {});

  // The graph with the settings' number of neighbours, built at the first cut. Cancelled: must not be used.
  const FlowGraph& graph(const CutSettings& settings, const Job& job = {});

  // Builds ahead what a first cut with the settings needs.
  void make_ready(const CutSettings& settings, const Job& job = {}) {
    CutSolver& ready = solver(settings, job);
    if (!job.cancelled()) ready.make_ready();
  }

  // Of all that is kept beside the scene and its solver. What forget_views() leaves: cuts and answers.
  std::size_t bytes() const;
  void forget_views();  // the pictures of views, and selections on them: they are drawn again when asked for

 private:
  struct Kept {  // a cut from the reference
    std::string key;
    CutSettings settings;
    CutResult result;
    std::string sums_key;  // masks that `sums` was added up from
    std::optional<MaskedSums> sums;
  };
  struct Answer {  // the labels of a cut, after step 3; empty: nothing was found
    std::string key;
    CutSettings settings;
    std::vector<std::uint8_t> labels;
  };
  struct Asked;

  bool graph_stands(const CutSettings& settings) const;
  CutSolver& solver(const CutSettings& settings, const Job& job);
  CutScene scene_for(const CutRequest& request, const CutSettings& settings, const Job& job);
  Asked asked(const CutRequest& request, const CutSettings& settings) const;
  Kept* kept(const Asked& asked);
  Kept& from_reference(const Asked& asked, const Job& job, const OnSnapshot& on_snapshot, bool* fresh);
  bool add_up_views(const CutResult& result, const CutSettings& settings, const Job& job, Kept* first);
  Likelihood evidence(const Asked& asked, const Job& job, Kept* first, CutResult* result);
  void correct(const Asked& asked, const Job& job, Kept* first, CutResult* result);
  CutResult solved(const CutRequest& request, const CutSettings& settings, const Job& job,
                   const OnSnapshot& on_snapshot);
  Answer* kept_answer(const CutRequest& request, const CutSettings& settings);
  std::vector<std::uint8_t> labels_of(const CutRequest& request, const CutSettings& settings, const Job& job,
                                      std::vector<StageTime>* stages);
  std::size_t kept_bytes() const;

  LocalScene scene_;
  std::optional<FlowGraph> graph_;
  std::optional<CutSolver> solver_;
  KeptViews views_;
  StrokeReplay strokes_;
  std::list<Kept> kept_;       // most recent first
  std::list<Answer> answers_;  // most recent first
  Kept cancelled_;             // what came of the last cut that was not finished
};

}  // namespace splatcut
