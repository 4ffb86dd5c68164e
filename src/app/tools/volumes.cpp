// The sphere and the box in space.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/tools/tool_hand.h"

namespace splatcut {

namespace {

Icon ball() {
  std::vector<glm::vec2> equator;
  for (int i = 0; i <= 20; ++i) {
    const float t = glm::pi<float>() * static_cast<float>(i) / 20;
    equator.emplace_back(0.9f * std::cos(t), 0.3f * std::sin(t));
  }
  return {icon_ring(0, 0, 0.9f), icon_line(std::move(equator))};
}

Icon cube() {
  return {
      icon_loop({{0, -0.95f}, {0.85f, -0.5f}, {0.85f, 0.5f}, {0, 0.95f}, {-0.85f, 0.5f}, {-0.85f, -0.5f}}),
      icon_line({{-0.85f, -0.5f}, {0, 0}, {0.85f, -0.5f}}), icon_line({{0, 0}, {0, 0.95f}})};
}

bool wants_round(const ToolHand& hand) {
  return hand.context.view.tool == Tool::kSphere;
}

void grab_handle(ToolHand& hand) {
  constexpr float kReachPoints = 10;
  ToolState& state = hand.state;
  state.volume_pressed = state.volume;
  if (!state.volume || state.volume->round != wants_round(hand)) return;
  const std::vector<glm::vec2> handles = handles_px(*state.volume, hand.context.pane_camera);
  std::size_t nearest = 0;
  for (std::size_t h = 0; h < handles.size(); ++h)
    if (glm::distance(handles[h], hand.at_px) < glm::distance(handles[nearest], hand.at_px)) nearest = h;
  if (handles.empty() ||
      glm::distance(handles[nearest], hand.at_px) > kReachPoints * hand.context.pixels_per_point)
    return;
  state.handle = nearest;
  state.volume_before = state.volume;
}

// While it is dragged: a new one around the point that was pressed, or the old one by its handle.
void shape_volume(ToolHand& hand) {
  ToolState& state = hand.state;
  const std::vector<glm::vec2>& path = state.path_px;
  const Camera& camera = hand.context.pane_camera;
  if (state.handle) {
    state.volume = dragged(*state.volume_before, *state.handle, path[0], path[1], camera);
    return;
  }
  if (!state.volume_before) {
    const auto centre = hand.context.pick(path.front());
    if (!centre) return;
    const glm::vec3 up = hand.context.camera.up_world(), y(0, 1, 0);
    const float cosine = glm::dot(y, up);
    const glm::vec3 axis = glm::cross(y, up);
    state.volume_before =
        Volume{wants_round(hand), centre->position_world, glm::vec3(0),
               cosine < -0.999f ? glm::quat(0, 1, 0, 0)
                                : glm::normalize(glm::quat(1 + cosine, axis.x, axis.y, axis.z))};
  }
  state.volume = state.volume_before;
  const float depth = camera.camera_from_world(state.volume->centre_world).z;
  state.volume->half = glm::vec3(glm::length(path[1] - path[0]) * depth / camera.fy_px);
}

void finish_volume(ToolHand& hand) {
  ToolState& state = hand.state;
  const bool adjusts = state.handle.has_value();
  constexpr float kLeastPoints = 2;  // less is no drag
  const std::vector<glm::vec2>& path = state.path_px;
  const bool far_enough =
      path.size() == 2 && glm::distance(path[0], path[1]) >= kLeastPoints * hand.context.pixels_per_point;
  const bool made = state.volume && state.volume_before && far_enough && state.volume->half.x > 0;
  state.handle.reset();
  state.volume_before.reset();
  if (!made) {
    state.volume = state.volume_pressed;
    return;
  }
  if (!adjusts) state.volume_set = hand.operation();
  hand.ask(SelectVolume{*state.volume, state.volume_set, adjusts});
}

void show_volume(const ToolState& state, const Camera& camera, ToolOverlay* out) {
  out->points_px.clear();
  if (!state.volume) return;
  out->handles_px = handles_px(*state.volume, camera);
  if (out->handles_px.empty()) return;
  out->points_px = {out->handles_px.front()};
  out->radius_px = state.volume->round ? glm::distance(out->handles_px[0], out->handles_px[1]) : 0;
  if (!state.volume->round) out->edges_px = edges_px(*state.volume, camera);
}

constexpr Tool volume_tool(Tool tool) {
  tool.hint = "drag from a surface, then its handles";
  tool.drag = Tool::Drag::kCorners;
  tool.selects = Tool::Selects::kSpace;
  tool.press = grab_handle;
  tool.move = shape_volume;
  tool.release = finish_volume;
  tool.shape = ToolShape::kCircle;
  tool.show = show_volume;
  return tool;
}

}  // namespace

constinit const Tool Tool::kSphere = volume_tool({
    .name = "Sphere",
    .key = '9',
    .sentence = "Drag from a point on a surface: everything in the sphere is selected. Its handles change it "
                "afterwards.",
    .icon = ball,
});

constinit const Tool Tool::kVolume = volume_tool({
    .name = "Box in space",
    .key = 'Y',
    .sentence = "Drag from a point on a surface: everything in the box is selected. Its handles change it "
                "afterwards.",
    .icon = cube,
});

}  // namespace splatcut
