#include "app/tools/pointer_tools.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/ranks.h"

namespace splatcut {

namespace {

constexpr float kDragPoints = 4;  // less is a click
constexpr float kScaleLeavePoints = 12;
constexpr float kPathStepPoints = 2;  // points of a path are no closer

// Nothing that the middle of the picture shows lies before the pivot: in a room the scene's middle may be
// behind the wall that one looks at.
void keep_pivot_in_sight(const ToolContext& context) {
  const Camera& pane = context.pane_camera;
  std::vector<float> depths;
  for (const float x : {-0.1f, 0.0f, 0.1f})
    for (const float y : {-0.1f, 0.0f, 0.1f})
      if (const auto depth = context.depth({pane.cx_px + x * static_cast<float>(pane.width_px),
                                            pane.cy_px + y * static_cast<float>(pane.height_px)}))
        depths.push_back(*depth);
  if (!depths.empty()) context.camera.keep_pivot_within(median(std::move(depths)));
}

}  // namespace

std::vector<Command> PointerTools::use(void (*what)(ToolHand&), const glm::vec2& at_px,
                                       const ToolContext& context) {
  ToolHand hand{state_, context, at_px, {}};
  if (what) what(hand);
  return std::move(hand.commands);
}

std::vector<Command> PointerTools::press(const glm::vec2& pixel, PointerButton button,
                                         const Modifiers& modifiers, const ToolContext& context) {
  if (state_.button) return {};  // one drag at a time
  state_.button = button;
  state_.modifiers = modifiers;
  state_.pressed_px = state_.pointer_px = pixel;
  pressed_depth_ = context.depth(pixel);
  const Tool& tool = tool_of(context.view.tool);
  if (button == PointerButton::kMiddle) {
    drag_ = modifiers.shift ? Drag::kPan : Drag::kOrbit;
    if (drag_ == Drag::kOrbit) keep_pivot_in_sight(context);
  } else if (tool.drag != Tool::Drag::kNavigates && (button == PointerButton::kLeft || tool.right_drags)) {
    drag_ = Drag::kShape;
    state_.path_px.assign(1, pixel);
    return use(tool.press, pixel, context);
  } else {
    drag_ = Drag::kMaybeClick;
  }
  return {};
}

std::vector<Command> PointerTools::move(const glm::vec2& pixel, const Modifiers& modifiers,
                                        const ToolContext& context) {
  const glm::vec2 delta = pixel - state_.pointer_px;
  const float per_point = context.pixels_per_point;
  state_.pointer_px = pixel;
  if (glm::length(pixel - state_.scale_at_px) > kScaleLeavePoints * per_point)
    state_.scale_armed = state_.at_last_click = false;
  if (!state_.button) return {};
  state_.modifiers = modifiers;
  if (drag_ == Drag::kMaybeClick && glm::length(pixel - state_.pressed_px) > kDragPoints * per_point) {
    drag_ = state_.right() ? Drag::kPan : Drag::kOrbit;
    if (drag_ == Drag::kOrbit) keep_pivot_in_sight(context);
  }
  if (moves_camera() && at_work()) return {};  // as for the wheel
  if (drag_ == Drag::kOrbit) context.camera.orbit(delta / per_point);
  if (drag_ == Drag::kPan)
    context.camera.pan(delta,
                       2 * context.pane_camera.fy_px * std::tan(0.5f * context.camera.pose().fov_y_rad),
                       pressed_depth_);
  if (drag_ != Drag::kShape) return {};
  const Tool& tool = tool_of(context.view.tool);
  std::vector<glm::vec2>& path = state_.path_px;
  if (tool.drag == Tool::Drag::kCorners)
    path.resize(1);
  else if (glm::length(pixel - path.back()) < kPathStepPoints * per_point)
    return {};
  path.push_back(pixel);
  return use(tool.move, pixel, context);
}

std::vector<Command> PointerTools::release(const glm::vec2& pixel, PointerButton button,
                                           const Modifiers& modifiers, const ToolContext& context) {
  if (state_.button != button) return {};
  std::vector<Command> commands = move(pixel, modifiers, context);
  const Tool& tool = tool_of(context.view.tool);
  Drag drag = std::exchange(drag_, Drag::kNone);
  const bool moved = glm::length(pixel - state_.pressed_px) > kDragPoints * context.pixels_per_point;
  if (drag == Drag::kShape && tool.clicks_object && !moved) {
    drag = Drag::kMaybeClick;
    state_.path_px.clear();
  }
  if (drag == Drag::kShape) {
    commands = use(tool.release, pixel, context);
    state_.path_px.clear();
  }
  if (drag == Drag::kMaybeClick) commands = use(tool.click, state_.pressed_px, context);
  state_.button.reset();
  return commands;
}

std::vector<Command> PointerTools::confirm(const ToolContext& context) {
  return use(tool_of(context.view.tool).confirm, state_.pointer_px, context);
}

bool PointerTools::abandon() {
  const bool any = at_work() || !state_.points_world.empty() || state_.volume;
  state_.volume.reset();
  state_.volume_before.reset();
  state_.volume_pressed.reset();
  state_.handle.reset();
  state_.path_px.clear();
  state_.corners_px.clear();
  state_.points_world.clear();
  state_.scale_armed = false;
  if (drag_ == Drag::kShape) drag_ = Drag::kNone;
  return any;
}

void PointerTools::let_go() {
  state_.button.reset();
  drag_ = Drag::kNone;
}

std::vector<Command> PointerTools::double_click(const glm::vec2& pixel, const ToolContext& context) {
  return use(tool_of(context.view.tool).double_click, pixel, context);
}

std::vector<Command> PointerTools::wheel(float steps, const Modifiers& modifiers,
                                         const ToolContext& context) {
  constexpr float kBrushStep = 1.15f;
  if (modifiers.alt) {
    ViewState view = context.view;
    view.brush_px = std::clamp(view.brush_px * std::pow(kBrushStep, steps), kLeastBrushPx, kMostBrushPx);
    return {SetView{view}};
  }
  if (at_work()) return {};  // the view stays under what is drawn
  if ((state_.scale_armed || modifiers.shift) && steps != 0) return {StepScale{steps > 0 ? 1 : -1}};
  const glm::vec2& at = state_.pointer_px;
  const float depth = context.depth(at).value_or(context.camera.pose().distance);
  context.camera.zoom(steps, context.pane_camera.world_from_pixel(at, depth));
  return {};
}

void PointerTools::hold(const Modifiers& modifiers) {
  if (!state_.button) state_.modifiers = modifiers;
}

ToolOverlay PointerTools::overlay(const ViewState& view, const Camera& camera, float pixels_per_point) const {
  ToolOverlay out;
  out.radius_px = tool_of(view.tool).brush * view.brush_px * pixels_per_point;
  out.operation = state_.operation(view);
  out.rest = state_.rest();
  out.cuts = tool_of(view.tool).strokes;
  out.shape = tool_of(view.tool).shape;
  out.points_px = state_.path_px;
  if (tool_of(view.tool).show) tool_of(view.tool).show(state_, camera, &out);
  if (out.points_px.empty()) out.shape = ToolOverlay::Shape::kNone;
  return out;
}

}  // namespace splatcut
