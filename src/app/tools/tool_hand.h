// Arguments of a tool's functions: the event, what the hand has done so far, and what the tool may see and
// move.
//
// Positions are viewport pixels, x right, y down.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/document/command.h"
#include "app/picture/camera_controller.h"
#include "app/tools/actions.h"

namespace splatcut {

enum class PointerButton { kLeft, kRight, kMiddle };

// A point of the visible surface, and the Gaussian that shows there.
struct PickedPoint {
  glm::vec3 position_world{0};
  std::int32_t gaussian = -1;
};

// Surroundings that the tools may see and move.
struct ToolContext {
  CameraController& camera;
  const ViewState& view;
  Camera pane_camera;          // camera of the pane under the pointer, in viewport pixels
  float pixels_per_point = 1;  // pixels per logical pixel
  // Picks the visible surface under a pixel; none: nothing is there.
  std::function<std::optional<PickedPoint>(const glm::vec2& pixel)> pick;
  // Camera z of the surface under a pixel, scene units; none: it is not known.
  std::function<std::optional<float>(const glm::vec2& pixel)> depth;
  std::function<Flags()> seen;  // Gaussians that the pane shows; null: all
  // Takes away the click of the other label whose mark is under a pixel; none: no such mark is.
  std::function<std::optional<RemoveStroke>(const glm::vec2& pixel, SeedLabel label)> contradicted;
};

// Marks that the interface draws over the picture while a tool is at work.
struct ToolOverlay {
  using Shape = ToolShape;
  Shape shape = Shape::kNone;
  std::vector<glm::vec2> points_px;   // points of the path, or corners; for kCircle the centre
  float radius_px = 0;                // radius of the brush or circle
  bool rest = false;                  // true: the stroke says what does not belong to the object
  bool dots = false;                  // kPolygon: true: dots mark the corners
  bool counted = false;               // kPoints: true: numbers stand at the points
  std::vector<glm::vec2> handles_px;  // handles of a sphere or box in space
  Edges edges_px;                     // edges of that box
  bool cuts = false;                  // true: the shape is a stroke for the cut, not a region
  std::optional<float> length;        // distance of the two measured points, scene units
  SetOperation operation = SetOperation::kAdd;
};

// State that is kept from one event to the next. A change of tool drops everything unfinished.
struct ToolState {
  std::optional<PointerButton> button;  // button that is held; none: no drag goes on
  Modifiers modifiers;
  glm::vec2 pressed_px{0}, pointer_px{0};
  std::vector<glm::vec2> path_px;                // path of the drag; two corners with Tool::Drag::kCorners
  std::vector<glm::vec2> corners_px;             // corners clicked so far
  Modifiers corner_modifiers;                    // keys held at the last corner
  std::vector<glm::vec3> points_world;           // points clicked so far
  std::optional<Volume> volume, volume_before;   // volume with handles; the same before the drag
  std::optional<Volume> volume_pressed;          // volume to restore if the press is no drag
  SetOperation volume_set = SetOperation::kAdd;  // operation that `volume` was made with
  std::optional<std::size_t> handle;             // handle that is dragged
  bool scale_armed = false;                      // true: the wheel steps through parts ...
  glm::vec2 scale_at_px{0};                      // ... while the pointer stays near this place of a click
  bool at_last_click = false;                    // true: the pointer has not left that place since

  bool right() const { return button == PointerButton::kRight; }
  bool rest() const { return right() || modifiers.ctrl; }
  // Operation that the held keys ask for. Without keys, operation() returns that of the view, and
  // held_operation() returns kAdd.
  SetOperation operation(const ViewState& view) const;
  SetOperation held_operation() const;
};

// One event, and the commands that a tool answers it with.
struct ToolHand {
  ToolState& state;
  const ToolContext& context;
  glm::vec2 at_px{0};  // position of the event; of a click, where the button was pressed
  std::vector<Command> commands;

  void ask(Command command) { commands.push_back(std::move(command)); }
  void ask_stroke(Stroke stroke);  // adds the stroke; with Alt: keeps of the object what it alone would take
  // Selects by a mask of the pane's size. path_px: see SelectRegion.
  void ask_region(Mask region, std::vector<glm::vec2> path_px = {});
  SetOperation operation() const { return state.operation(context.view); }
  float brush_px() const {
    return tool_of(context.view.tool).brush * context.view.brush_px * context.pixels_per_point;
  }
};

// Marks of symbols, see IconMark.
IconMark icon_line(std::vector<glm::vec2> points, float wider = 0);
IconMark icon_loop(std::vector<glm::vec2> points);  // closed line
IconMark icon_dot(float x, float y, float radius);
IconMark icon_ring(float x, float y, float radius);

}  // namespace splatcut
