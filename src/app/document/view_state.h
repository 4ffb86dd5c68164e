// View and tool settings that are not part of the document. They are not undone; the window remembers them
// between runs.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "app/document/document.h"
#include "app/document/selection.h"
#include "app/document/tool_id.h"

namespace splatcut {

// Limits of the brush radius, logical pixels. Opening another scene limits the radius to kMostKeptBrushPx: a
// larger brush was meant for the scene it was used in.
inline constexpr float kLeastBrushPx = 1, kMostBrushPx = 120, kMostKeptBrushPx = 40;
// Limits of ViewState::fly_speed for a scene that is opened, and between runs; the wheel goes beyond them.
inline constexpr float kLeastKeptSpeed = 0.1f, kMostKeptSpeed = 10;

// Content of the panes. kWhole: the scene. kIsolate: the object alone. kHide: the scene without the object.
// kSideBySide: scene and object. kBeforeAfter: the object with its rows as they are, and with clean edges.
enum class DisplayMode { kWhole, kIsolate, kHide, kSideBySide, kBeforeAfter };

struct ViewState {
  ToolId tool = ToolId::kClick;
  SetOperation operation = SetOperation::kAdd;  // operation of the hand tools if no modifier key is held
  float brush_px = 14;                          // radius of the brush, logical pixels
  bool see_through = false;                     // region tools take what is hidden behind the surface, too
  bool by_centre = false;                       // hand tools go by centres, not by footprints, see TakenBy
  float depth_limit = 0;                        // reach behind the surface over the scene's size; 0: no limit
  DisplayMode display = DisplayMode::kWhole;
  // Objects that the scene is shown without, whichever is chosen. Alone they show; exports have them.
  std::vector<ObjectId> hidden = {};
  bool clean_edges = true;  // an object shown alone, or exported, has clean edges
  bool fill_hole =
      false;            // what the object hid is continued where it is not shown, and in exports of the rest
  bool tint = true;     // objects are tinted
  bool outline = true;  // objects have outlines
  bool heat = false;    // the heat map of the likelihood replaces the tint
  // Set: the object, shown alone, is coloured by how many views saw it; what was shown before, to go back to.
  std::optional<DisplayMode> seen_heat;
  float near_share = 0.01f;  // distance of the near plane over the scene's size; see natural_near_plane()
  float far_share = 0;       // distance of the far plane over the scene's size; 0: no far plane
  float fly_speed = 1;       // speed of flight over the usual speed
  float colour_tolerance = 0.1f;  // tolerance of eyedropper and flood, see select_colour()
  bool checker = false;           // a checker replaces the document's background
  bool centres = false;           // dots mark the centres of the Gaussians
  bool rings = false;             // rings outline the Gaussians' ellipses
  bool grid = false;              // a grid lies on the ground
  bool web_low_pass = false;      // splats are as thin as in web viewers, see kWebLowPassPx2

  bool operator==(const ViewState&) const = default;
};

// Sets what the program keeps between runs as it is in `kept`.
inline void set_what_is_kept(const ViewState& kept, ViewState* view) {
  view->brush_px = kept.brush_px;
  view->fly_speed = std::clamp(kept.fly_speed, kLeastKeptSpeed, kMostKeptSpeed);
  view->tint = kept.tint;
  view->outline = kept.outline;
  view->web_low_pass = kept.web_low_pass;
}

// Shows something else; what belongs to the object shown alone ends with that.
inline void show(DisplayMode mode, ViewState* view) {
  view->display = mode;
  if (mode != DisplayMode::kIsolate) view->seen_heat.reset();
}

// The view after a key that switches to a display, or from it back to the whole scene.
ViewState turned_over(ViewState view, DisplayMode mode);
// The scene without the chosen object, or back: then it is not hidden by its eye either.
ViewState turned_hide(ViewState view, ObjectId chosen);
// An object by the eye in its row: hidden, or shown however it was hidden.
ViewState turned_eye(ViewState view, ObjectId object, ObjectId chosen);
// Side by side with the scene; where the object is shown alone already, beside itself as its rows are.
ViewState turned_side_by_side(ViewState view);
// The object alone by how many views saw it, or back.
ViewState turned_seen_heat(ViewState view);
// Without the object, the hole that it leaves filled; where that is shown, not filled.
ViewState turned_fill_hole(ViewState view);

// What is known of the object that a pane shows.
struct ShownObject {
  std::string name;
  bool clean = false;                  // drawn with clean edges
  bool heat = false, looking = false;  // by how many views it was seen is known; is being looked for
  bool filled = false;                 // the hole that it leaves is filled
  bool outlined = false;               // that hole has an outline, or the ground that no view showed
};
// The label of a pane that shows something else than the scene as it is; empty: it needs none.
std::string label_of(const ViewState& view, const ShownObject& object);

// True if the scene is shown without the object.
inline bool hides(const ViewState& view, ObjectId object, ObjectId chosen) {
  return std::ranges::find(view.hidden, object) != view.hidden.end() ||
         (object == chosen && view.display == DisplayMode::kHide);
}
// The same of the chosen object, in the pane at the left.
inline bool hides_chosen(const ViewState& view, ObjectId chosen) {
  return view.display != DisplayMode::kIsolate && view.display != DisplayMode::kBeforeAfter &&
         hides(view, chosen, chosen);
}

// True if a pane shows an object with clean edges.
inline bool shows_clean_edges(const ViewState& view) {
  const bool alone = view.display == DisplayMode::kIsolate || view.display == DisplayMode::kSideBySide;
  return view.display == DisplayMode::kBeforeAfter || (alone && view.clean_edges);
}

// True if the pane shows the scene without the object, the hole that this leaves filled.
inline bool shows_filled_hole(const ViewState& view) {
  return view.display == DisplayMode::kHide && view.fill_hole;
}

// True if the pane shows by how many views the object was seen.
inline bool shows_seen_heat(const ViewState& view) {
  return view.seen_heat.has_value() && view.display == DisplayMode::kIsolate;
}

}  // namespace splatcut
