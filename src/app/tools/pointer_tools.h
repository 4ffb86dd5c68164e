// The pointer in the viewport: navigation and tools. Events come in, commands go out; the class knows no
// window.
//
// A middle drag always orbits, and pans with Shift. If the tool does not take drags, a left drag orbits and a
// right drag pans. Positions are viewport pixels, x right, y down.
#pragma once

#include <optional>
#include <vector>

#include "app/tools/tool_hand.h"

namespace splatcut {

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
  bool abandon();  // drops a shape or a drag; returns true if there was one
  void let_go();   // forgets the button that is held: its release may never come, and means nothing

  // dragging(): a button is held. at_work(): a shape is begun.
  bool dragging() const { return state_.button.has_value(); }
  bool at_work() const { return !state_.path_px.empty() || !state_.corners_px.empty(); }
  bool moves_camera() const { return drag_ == Drag::kOrbit || drag_ == Drag::kPan; }
  bool scale_armed() const { return state_.scale_armed; }  // true: the wheel steps through parts
  // True: the pointer has not left the place of the last click, whose mark it does not mean.
  bool at_last_click() const { return state_.at_last_click; }
  void leave_last_click() { state_.at_last_click = false; }  // the view moved below the pointer
  void disarm_scale() { state_.scale_armed = false; }        // the click has none: the wheel zooms
  const glm::vec2& pointer_px() const { return state_.pointer_px; }
  void hold(const Modifiers& modifiers);  // sets the keys that are held now, unless a drag goes on
  ToolOverlay overlay(const ViewState& view, const Camera& camera, float pixels_per_point) const;
  // Number of points that the user has clicked so far with Set up or Measure.
  std::size_t points_set() const { return state_.points_world.size(); }

 private:
  enum class Drag { kNone, kMaybeClick, kOrbit, kPan, kShape };
  std::vector<Command> use(void (*what)(ToolHand&), const glm::vec2& at_px, const ToolContext& context);

  ToolState state_;
  Drag drag_ = Drag::kNone;
  std::optional<float> pressed_depth_;
};

}  // namespace splatcut
