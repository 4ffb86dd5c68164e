// From the document to what the panes show: which Gaussians are drawn, whose each is, what is outlined.
//
// A few passes over all Gaussians, so it runs on a worker from a snapshot of what it reads.
#pragma once

#include <array>
#include <map>

#include "app/document/clean_objects.h"
#include "app/document/label_cache.h"
#include "app/document/scene_graph.h"
#include "app/document/view_state.h"
#include "app/picture/frame_shading.h"
#include "segment/session/session.h"

namespace splatcut {

struct StyleOrder {
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<SceneGraph> graph;  // for floaters
  Document document;
  std::map<ObjectId, Flags> previews;                    // cuts shown in place of the object's own
  std::shared_ptr<const std::vector<float>> likelihood;  // of the active object, for the heat map
  std::shared_ptr<const CleanObjects> clean;
  ViewState view;
  float pixels_per_point = 1;
  bool floaters = false;  // of the active object, outlined
};

struct Styles {
  int panes = 0;               // 1 or 2; 0: not made yet
  std::array<Flags, 2> shown;  // per pane: Gaussians that it draws; null: all
  std::array<FrameStyle, 2> style;
  std::array<std::shared_ptr<const CleanObject>, 2> clean;  // per pane: drawn in place of the scene's rows
  Flags active_labels;  // of the active object, all 0 without one; null: none yet
  std::size_t floaters = 0;
};

// before: the last result; an equal set of shown Gaussians stays the same object, as the picture need not be
// rasterised again then.
Styles styled(const StyleOrder& order, const Styles& before, LabelCache* labels);

}  // namespace splatcut
