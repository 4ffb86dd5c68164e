// Tools that make strokes for the cut.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/tools/tool_hand.h"

namespace splatcut {

namespace {

Icon arrow_with_rays() {
  Icon icon = {icon_loop({{-0.25f, -0.3f}, {0.75f, 0.25f}, {0.25f, 0.38f}, {0.05f, 0.9f}})};
  for (const float angle : {-2.7f, -2.1f, -1.5f})
    icon.push_back(icon_line({{-0.32f + 0.35f * std::cos(angle), -0.36f + 0.35f * std::sin(angle)},
                              {-0.32f + 0.68f * std::cos(angle), -0.36f + 0.68f * std::sin(angle)}}));
  return icon;
}

void click_object(ToolHand& hand) {
  ToolState& state = hand.state;
  const SeedLabel label = state.rest() ? SeedLabel::kRest : SeedLabel::kObject;
  const bool adds = state.at_last_click || state.modifiers.alt;
  const auto gone = adds ? std::nullopt : hand.context.contradicted(hand.at_px, label);
  state.at_last_click = !gone;
  state.scale_at_px = hand.at_px;
  if (gone) {
    state.scale_armed = false;
    return hand.ask(*gone);
  }
  Stroke stroke = click(hand.at_px, label);
  stroke.radius_px *= hand.context.pixels_per_point;
  if (!state.modifiers.alt) state.scale_armed = true;
  hand.ask_stroke(std::move(stroke));
}

Icon wave() {
  std::vector<glm::vec2> points;
  for (int i = 0; i <= 24; ++i) {
    const float t = static_cast<float>(i) / 24;
    points.emplace_back(-0.9f + 1.8f * t, 0.55f * std::sin(t * 2.6f * glm::pi<float>()) * (1 - 0.3f * t));
  }
  return {icon_line(std::move(points), 0.8f)};
}

}  // namespace

constinit const Tool Tool::kClick = {
    .name = "Click an object",
    .key = '2',
    .sentence =
        "Left click: this is the object. Right click (or Ctrl): this is not. The wheel right after it takes "
        "more or less. A right click on the dot of a click (left: of a right one) takes that click away. "
        "Dragging turns the view.",
    .hint =
        "left click: object   right click: rest   wheel after it: more or less   Alt: intersect   drag: turn",
    .icon = arrow_with_rays,
    .first_of_group = true,
    .strokes = true,
    .shows_keys = true,
    .clicks_object = true,
    .click = click_object,
};

constinit const Tool Tool::kScribble = {
    .name = "Scribble",
    .key = '3',
    .sentence = "Drag over what belongs to the object; with the right button (or Ctrl) over what does not.",
    .hint = "left: object   right: rest",
    .icon = wave,
    .drag = Drag::kPath,
    .right_drags = true,
    .brush = 0.5f,
    .strokes = true,
    .shows_keys = true,
    .release =
        [](ToolHand& hand) {
          const SeedLabel label = hand.state.rest() ? SeedLabel::kRest : SeedLabel::kObject;
          hand.ask_stroke({label, hand.brush_px(), hand.state.path_px});
        },
    .shape = ToolShape::kPath,
};

constinit const Tool Tool::kBox = {
    .name = "Box around the object",
    .key = '4',
    .sentence =
        "Drag a box around the object. Shift adds what is in the box, the right button (or Ctrl) removes it, "
        "Alt keeps of the object what is in it. Clicks correct it, as with Click an object.",
    .hint = "drag around the object   Shift: add   right (or Ctrl): remove   Alt: intersect",
    .icon =
        [] {
          return Icon{icon_loop({{-0.9f, -0.75f}, {0.9f, -0.75f}, {0.9f, 0.75f}, {-0.9f, 0.75f}}),
                      icon_dot(0, 0, 0.32f)};
        },
    .drag = Drag::kCorners,
    .right_drags = true,
    .strokes = true,
    .shows_keys = true,
    .clicks_object = true,
    .release =
        [](ToolHand& hand) {
          const std::vector<glm::vec2>& corners = hand.state.path_px;
          if (corners.size() == 2)
            hand.ask(AddBox{hand.context.pane_camera, corners[0], corners[1], hand.context.seen(),
                            hand.state.right() ? SetOperation::kRemove : hand.state.held_operation()});
        },
    .click = click_object,
    .shape = ToolShape::kRectangle,
};

}  // namespace splatcut
