// Styles of the panes, made from the document: the Gaussians to draw, the object that each belongs to, and
// what is outlined.
//
// Making them takes a few passes over all Gaussians, so it runs on a worker from a snapshot of its inputs.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "app/document/clean_objects.h"
#include "app/document/command.h"
#include "app/document/label_cache.h"
#include "app/document/scene_graph.h"
#include "app/document/seen_object.h"
#include "app/document/view_state.h"
#include "app/picture/frame_shading.h"
#include "segment/session/session.h"

namespace splatcut {

struct StyleOrder {
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<SceneGraph> graph;  // graph of the cloud, to find floaters
  Document document;
  std::map<ObjectId, Flags> previews;                    // cuts to show in place of the objects' own
  std::shared_ptr<const std::vector<float>> likelihood;  // likelihood of the active object, for the heat map
  std::shared_ptr<const CleanObjects> clean;
  ViewState view;
  float pixels_per_point = 1;                // pixels per logical pixel
  bool floaters = false;                     // true: floaters of the active object are outlined
  std::optional<SelectRangeOrColour> range;  // outlined if there are no floaters; depths are the camera's
  Camera camera;
  std::shared_ptr<const SeenObject> seen = {};  // of some object, for the heat of the object alone
};

struct Styles {
  int panes = 0;  // number of panes, 1 or 2; 0: the styles are not made yet
  DisplayMode display = DisplayMode::kWhole;
  std::array<Flags, 2> shown;  // flags per pane of the Gaussians to draw; null: all
  std::array<FrameStyle, 2> style;
  // Gaussians per pane that are drawn in place of the scene's rows; null: the rows. Alone, an object with
  // clean edges: until it is cleaned anew after its labels changed it is as before where they are the same,
  // and not `cleaned` in its report. Without the object, the scene with its hole filled.
  std::array<std::shared_ptr<const CleanObject>, 2> clean;
  // What leaves and comes there, of the labels before as long as that is computed anew; null: not known.
  std::shared_ptr<const SceneWithout> without;
  bool unfinished = false;   // true: clean edges, or the filled hole, are to be shown and were not known
  Flags active_labels;       // labels of the active object, all 0 without one; null: they are not made yet
  std::size_t floaters = 0;  // number of Gaussians in floaters
};

// Makes the styles. before: the last result. If the set of shown Gaussians has not changed, it stays the same
// shared array, so that the picture need not be rasterised again. labels: cache of the calling thread.
// Throws Error if the search for neighbours, for floaters, is cancelled.
Styles styled(const StyleOrder& order, const Styles& before, LabelCache* labels, const Job& job = {});

}  // namespace splatcut
