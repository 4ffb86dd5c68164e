// What the pointer does in the viewport: navigation and the tools. Events in, commands out; knows no window.
//
// Middle drag always orbits (with Shift pans). Where the tool does not take a drag, a left one orbits and a
// right one pans.
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
  bool abandon();  // drops a shape or a drag; true where there was one

  bool dragging() const { return state_.button.has_value(); }
  bool at_work() const { return !state_.path_px.empty() || !state_.corners_px.empty(); }
  bool moves_camera() const { return drag_ == Drag::kOrbit || drag_ == Drag::kPan; }
  bool scale_armed() const { return state_.scale_armed; }  // the wheel steps through parts
  const glm::vec2& pointer_px() const { return state_.pointer_px; }
  void hold(const Modifiers& modifiers);  // keys that are held now
  ToolOverlay overlay(const ViewState& view, const Camera& camera, float pixels_per_point) const;
  std::size_t points_set() const { return state_.points_world.size(); }

 private:
  enum class Drag { kNone, kMaybeClick, kOrbit, kPan, kShape };
  std::vector<Command> use(void (*what)(ToolHand&), const glm::vec2& at_px, const ToolContext& context);

  ToolState state_;
  Drag drag_ = Drag::kNone;
  std::optional<float> pressed_depth_;
};

}  // namespace splatcut
