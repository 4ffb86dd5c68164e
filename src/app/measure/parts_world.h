// The any-view robot on the selection of parts alone, without the cut: for searches over many models.
//
// In: a scene with truth. Out: what the robot needs of it, drawn once: the hierarchy, a soft view of each
// view with truth, its truth at that size. The cloud itself is no longer needed. Cost: one drawing a view;
// then some 10 ms a click.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/measure/any_view.h"
#include "segment/selection/leaf_view.h"

namespace splatcut {

struct PartsScene {
  std::string name;
  PartHierarchy parts;
  std::vector<LeafView> views;       // with truth, then those of starts without
  std::vector<TruthView> truths;     // of the first of them, in their pixels
  std::vector<AnyViewStart> starts;  // in their pixels
  std::vector<float> zoom;           // per start: at so many times its own distance
};

struct PartsSceneOptions {
  int max_width_px = 320;       // of views,
  int least_object_px = 96;     // square root of the truth's pixels: wider where it has fewer
  std::size_t most_starts = 4;  // the first so many,
  std::size_t most_views = 12;  // and so many views with truth, evenly chosen
  std::vector<float> zooms{1};  // each start at so many times the distance
  FirstStrokes first;
};

// One of its views. The camera must be one of theirs.
const LeafView& view_of(const PartsScene& scene, const Camera& camera);

// Cancelled: must not be used.
PartsScene parts_scene(const EvaluationCase& scene, PartHierarchy parts, const PartsSceneOptions& options,
                       const Job& job = {});

// The robot's world: what the clicks mean by this model. scene must outlive it.
AnyViewWorld parts_world(const PartsScene& scene, const SelectionModel& model);

}  // namespace splatcut
