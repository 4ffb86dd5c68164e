// What a tool is given: where the hand is, what it has done so far, what may be seen and moved.
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

struct PickedPoint {
  glm::vec3 position_world{0};
  std::int32_t gaussian = -1;
};

// What the tools may see and move.
struct ToolContext {
  CameraController& camera;
  const ViewState& view;
  Camera pane_camera;  // of the pane under the pointer, in viewport pixels
  float pixels_per_point = 1;
  std::function<std::optional<PickedPoint>(const glm::vec2& pixel)> pick;  // the visible surface
  std::function<std::optional<float>(const glm::vec2& pixel)> depth;  // camera z there, as far as it is known
  std::function<Flags()> seen;  // Gaussians that the pane shows; null: all
};

// What the interface draws over the picture while a tool is at work.
struct ToolOverlay {
  using Shape = ToolShape;
  Shape shape = Shape::kNone;
  std::vector<glm::vec2> points_px;   // path, corners; for kCircle the centre
  float radius_px = 0;                // brush radius, circle radius
  bool rest = false;                  // the stroke says what does not belong
  bool dots = false;                  // kPolygon: at its corners
  bool counted = false;               // kPoints: with their numbers
  std::vector<glm::vec2> handles_px;  // of a sphere or box in space
  Edges edges_px;                     // of that box
  bool cuts = false;                  // a stroke for the cut, not a region
  std::optional<float> length;        // between the two points that are measured, scene units
  SetOperation operation = SetOperation::kAdd;
};

// Kept from one event to the next; another tool begins with everything unfinished dropped.
struct ToolState {
  std::optional<PointerButton> button;  // that is held
  Modifiers modifiers;
  glm::vec2 pressed_px{0}, pointer_px{0};
  std::vector<glm::vec2> path_px;                // of the drag; two corners where Tool::drag says so
  std::vector<glm::vec2> corners_px;             // that were clicked
  Modifiers corner_modifiers;                    // of the last of them
  std::vector<glm::vec3> points_world;           // that were clicked
  std::optional<Volume> volume, volume_before;   // that can be changed by its handles; before a drag did
  std::optional<Volume> volume_pressed;          // that was there, should the press be no drag
  SetOperation volume_set = SetOperation::kAdd;  // that it was made with
  std::optional<std::size_t> handle;             // that is dragged
  bool scale_armed = false;                      // the wheel steps through parts ...
  glm::vec2 scale_at_px{0};                      // ... as long as the pointer stays here

  bool right() const { return button == PointerButton::kRight; }
  bool rest() const { return right() || modifiers.ctrl; }
  // What the keys that are held say; without any: what the view says, or to add.
  SetOperation operation(const ViewState& view) const;
  SetOperation held_operation() const;
};

// One event.
struct ToolHand {
  ToolState& state;
  const ToolContext& context;
  glm::vec2 at_px{0};  // of a click: where it was pressed
  std::vector<Command> commands;

  void ask(Command command) { commands.push_back(std::move(command)); }
  void ask_stroke(Stroke stroke);  // Alt keeps of the object what it would take
  void ask_region(Mask region);    // of the pane
  SetOperation operation() const { return state.operation(context.view); }
  float brush_px() const {
    return tool_of(context.view.tool).brush * context.view.brush_px * context.pixels_per_point;
  }
};

// Marks of symbols.
IconMark icon_line(std::vector<glm::vec2> points, float wider = 0);
IconMark icon_loop(std::vector<glm::vec2> points);  // closed
IconMark icon_dot(float x, float y, float radius);
IconMark icon_ring(float x, float y, float radius);

}  // namespace splatcut
