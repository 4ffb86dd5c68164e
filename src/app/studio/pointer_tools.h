// What the pointer does in the viewport: navigation and the tools. Events in, commands out; knows no window.
//
// Positions are viewport pixels, x right, y down. Middle drag always orbits (with Shift pans). With the
// navigation and the click tool a left drag orbits and a right drag pans; other tools take the left drag, and
// scribble the right one.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/studio/actions.h"
#include "app/studio/camera_controller.h"
#include "app/studio/command.h"

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
  enum class Shape { kNone, kPath, kRectangle, kPolygon, kCircle, kPoints };
  Shape shape = Shape::kNone;
  std::vector<glm::vec2> points_px;   // path, corners; for kCircle the centre
  float radius_px = 0;                // brush radius, circle radius
  bool rest = false;                  // the stroke says what does not belong
  std::vector<glm::vec2> handles_px;  // of a sphere or box in space
  Edges edges_px;                     // of that box
  bool cuts = false;                  // a stroke for the cut, not a region
  std::optional<float> length;        // between the two points that are measured, scene units
  SetOperation operation = SetOperation::kAdd;
};

class PointerTools {
 public:
  std::vector<Command> press(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers,
                             const ToolContext& context);
  std::vector<Command> move(const glm::vec2& pixel, const Modifiers& modifiers, const ToolContext& context);
  std::vector<Command> release(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers,
                               const ToolContext& context);
  std::vector<Command> double_click(const glm::vec2& pixel, const ToolContext& context);
  std::vector<Command> wheel(float steps, const Modifiers& modifiers, const ToolContext& context);

  std::vector<Command> confirm(const ToolContext& context);  // closes a polygon
  bool abandon();  // drops a shape or a drag; true where there was one

  bool dragging() const { return button_.has_value(); }
  bool at_work() const { return !path_.empty() || !corners_.empty(); }
  bool moves_camera() const { return drag_ == Drag::kOrbit || drag_ == Drag::kPan; }
  bool scale_armed() const { return scale_armed_; }  // the wheel steps through parts
  const glm::vec2& pointer_px() const { return last_; }
  void hold(const Modifiers& modifiers);  // keys that are held now
  ToolOverlay overlay(const ViewState& view, const Camera& camera, float pixels_per_point) const;
  std::size_t points_set() const { return points_.size(); }  // of the ground and measure tools

 private:
  enum class Drag { kNone, kMaybeClick, kOrbit, kPan, kShape };
  SetOperation operation(const ViewState& view, const Modifiers& modifiers) const;
  std::vector<Command> finish_shape(const ToolContext& context);
  std::vector<Command> click(const ToolContext& context);
  std::vector<Command> click_object(const ToolContext& context, bool right);
  std::vector<Command> click_ground(const ToolContext& context, bool right);
  void click_measure(const ToolContext& context, bool right);
  void start_shape(const glm::vec2& pixel);
  bool grab_handle(const glm::vec2& pixel, const ToolContext& context);
  void shape_volume(const ToolContext& context);
  std::vector<Command> finish_volume(SetOperation set);
  void show_volume(const Camera& camera, ToolOverlay* out) const;

  std::optional<PointerButton> button_;
  Modifiers modifiers_;
  Drag drag_ = Drag::kNone;
  glm::vec2 pressed_{0}, last_{0};
  std::optional<float> pressed_depth_;
  std::vector<glm::vec2> path_;  // scribble, brush, lasso; two corners of rectangle and box; centre and rim
  std::vector<glm::vec2> corners_;                // polygon
  std::optional<Volume> volume_, volume_before_;  // that can be changed by its handles; before a drag did
  SetOperation volume_set_ = SetOperation::kAdd;
  std::optional<std::size_t> handle_;  // that is dragged
  std::vector<glm::vec3> points_;      // world: of the ground, or the ends of what is measured
  bool scale_armed_ = false;
  glm::vec2 scale_at_{0};
};

}  // namespace splatcut
