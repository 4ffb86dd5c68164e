// From the reference view to a label per Gaussian: the stages of ARCHITECTURE.md from the first mask on.
//
// In: a scene with what is prepared of it, the reference with its strokes (or a mask of it).
// Out: labels (1 = object), the views used with their masks, likelihood, energy, milliseconds per stage.
// Source: Jain et al., GaussianCut, NeurIPS 2024; the propagator is ours: labels of a 3D cut rendered into
// the next view are its mask. Where views around the object are asked, they are added until the labels stop
// changing.
// Expected outcomes (nothing found, cancelled) are in `outcome`. Called by Session alone, see session.h.
#pragma once

#include <span>
#include <vector>

#include "core/job.h"
#include "scene/raster/projected_view.h"
#include "segment/graphcut/cut.h"
#include "segment/selection/stroke_replay.h"
#include "segment/session/cut_request.h"
#include "segment/session/cut_result.h"
#include "segment/session/cut_settings.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// What a run works on. solver: of the drawer's cloud and the graph, with the settings' cut.
struct CutScene {
  Drawer drawer;
  const FlowGraph& graph;
  const PartHierarchy& parts;
  const PartModel& model;
  CutSolver& solver;
  StrokeReplay& strokes;
  glm::vec3 up_world;                   // for the orbit
  std::span<const Camera> photographs;  // cameras of the capture, where known
};

// The cut from the reference: of the request, strokes in other views and views left out play no part.
CutResult cut_from_reference(const CutScene& scene, const ReferenceView& reference, const CutRequest& request,
                             const CutSettings& settings, const Job& job, const OnSnapshot& on_snapshot);

// The first mask alone, in the size of limited_to_width(reference, work_width_px), or larger where the object
// is small. Cancelled: empty, of that size.
Mask first_mask_of(const CutScene& scene, const ReferenceView& reference, const CutRequest& request,
                   const CutSettings& settings, const Job& job);

// What strokes are replayed with, and all of them in their order.
ReplayOptions replay_options(const CutRequest& request, const CutSettings& settings, const PartModel& model);
std::vector<CameraStroke> strokes_in_order(const CutRequest& request);

// trim() by the views that count. Returns how many Gaussians left the object.
std::size_t trim_to_views(const Drawer& drawer, const std::vector<ViewReport>& views,
                          const CutSettings& settings, std::vector<std::uint8_t>* labels, const Job& job);

}  // namespace splatcut
