// View and tool settings that are not part of the document: never undone, remembered between runs.
#pragma once

#include "app/document/selection.h"
#include "app/document/tool_id.h"

namespace splatcut {

// Brush radii, logical pixels. A brush larger than kMostKeptBrushPx was meant for the scene it was used in.
inline constexpr float kLeastBrushPx = 1, kMostBrushPx = 120, kMostKeptBrushPx = 40;

// kSideBySide: scene and object. kBeforeAfter: the object as its rows are, and with clean edges.
enum class DisplayMode { kWhole, kIsolate, kHide, kSideBySide, kBeforeAfter };

struct ViewState {
  ToolId tool = ToolId::kClick;
  SetOperation operation = SetOperation::kAdd;  // of the region tools, where no modifier key says otherwise
  float brush_px = 14;                          // radius, logical pixels
  bool see_through = false;                     // region tools take what is hidden behind, too
  float depth_limit = 0;                        // of the scene's size behind the surface; 0: no limit
  DisplayMode display = DisplayMode::kWhole;
  bool clean_edges = true;  // of the object where it is shown alone, and in what is exported
  bool tint = true;
  bool outline = true;
  bool heat = false;
  float near_share = 0.01f;       // near plane, of the scene's size; see natural_near_plane()
  float far_share = 0;            // far plane, of the scene's size; 0: none
  float fly_speed = 1;            // of the usual speed
  float colour_tolerance = 0.1f;  // of the eyedropper and the flood, as select_colour() has it
  bool checker = false;           // behind the scene, in place of the document's background
  bool centres = false;           // of the Gaussians, as dots
  bool rings = false;             // outlines of the Gaussians' ellipses
  bool grid = false;              // on the ground
  bool web_low_pass = false;      // splats as thin as web viewers draw them, see kWebLowPassPx2

  bool operator==(const ViewState&) const = default;
};

inline bool shows_clean_edges(const ViewState& view) {
  const bool alone = view.display == DisplayMode::kIsolate || view.display == DisplayMode::kSideBySide;
  return view.display == DisplayMode::kBeforeAfter || (alone && view.clean_edges);
}

}  // namespace splatcut
