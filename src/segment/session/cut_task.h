// What a cut from a reference view is given.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "core/job.h"
#include "scene/raster/projected_view.h"
#include "segment/graphcut/cut.h"
#include "segment/selection/stroke_replay.h"
#include "segment/session/cut_request.h"
#include "segment/session/cut_settings.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// The scene and what is prepared of it. solver: of the drawer's cloud and the graph, with the settings' cut.
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

// One cut: all of it outlives the cut.
struct CutTask {
  const CutScene& scene;
  const ReferenceView& reference;
  const CutRequest& request;
  const CutSettings& settings;
  const Job& job;
};

}  // namespace splatcut
