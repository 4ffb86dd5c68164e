// Tools that select Gaussians by hand, by a region of the picture.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "app/tools/tool_hand.h"

namespace splatcut {

namespace {

Icon noose() {
  std::vector<glm::vec2> points;
  for (int i = 0; i < 26; ++i) {
    const float t = 2 * glm::pi<float>() * static_cast<float>(i) / 26;
    points.emplace_back(0.9f * std::cos(t), -0.2f + 0.58f * std::sin(t) + 0.1f * std::sin(3 * t));
  }
  return {icon_loop(std::move(points)), icon_line({{-0.5f, 0.3f}, {-0.6f, 0.6f}, {-0.35f, 0.95f}})};
}

Icon dashed_rectangle() {
  const std::vector<glm::vec2> corners = {
      {-0.9f, -0.75f}, {0.9f, -0.75f}, {0.9f, 0.75f}, {-0.9f, 0.75f}, {-0.9f, -0.75f}};
  Icon icon;
  for (std::size_t side = 0; side + 1 < corners.size(); ++side)
    for (int i = 0; i < 3; ++i) {
      const glm::vec2 a = corners[side], b = corners[side + 1];
      const float s = static_cast<float>(i) / 3 + 0.06f, t = s + 0.2f;
      icon.push_back(icon_line({a + s * (b - a), a + t * (b - a)}));
    }
  return icon;
}

constexpr float kCloseClickPoints = 9;  // a click this near to the first corner closes the polygon

Icon quadrangle() {
  const std::vector<glm::vec2> corners = {{-0.75f, 0.7f}, {-0.6f, -0.55f}, {0.55f, -0.75f}, {0.75f, 0.45f}};
  Icon icon = {icon_loop(corners)};
  for (const glm::vec2& c : corners) icon.push_back(icon_dot(c.x, c.y, 0.2f));
  return icon;
}

void ask_polygon(ToolHand& hand, std::span<const glm::vec2> corners) {
  const Camera& camera = hand.context.pane_camera;
  hand.ask_region(polygon_region(corners, camera.width_px, camera.height_px));
}

void close_polygon(ToolHand& hand) {
  const std::vector<glm::vec2> corners = std::exchange(hand.state.corners_px, {});
  if (corners.size() >= 3) ask_polygon(hand, corners);
}

void click_corner(ToolHand& hand) {
  std::vector<glm::vec2>& corners = hand.state.corners_px;
  const float reach = kCloseClickPoints * hand.context.pixels_per_point;
  if (hand.state.right() || (corners.size() >= 3 && glm::length(hand.at_px - corners.front()) < reach))
    return close_polygon(hand);
  corners.push_back(hand.at_px);
  hand.state.corner_modifiers = hand.state.modifiers;
}

// Modifier keys held only for Enter do not count.
void confirm_polygon(ToolHand& hand) {
  const Modifiers held = std::exchange(hand.state.modifiers, hand.state.corner_modifiers);
  close_polygon(hand);
  hand.state.modifiers = held;
}

}  // namespace

constinit const Tool Tool::kBrush = {
    .name = "Brush",
    .key = '5',
    .sentence =
        "Paint over Gaussians to select them by hand. Of what is visible, it stays on the surface that "
        "you paint on.",
    .icon =
        [] {
          return Icon{
              icon_line({{0.9f, -0.9f}, {0.05f, 0.05f}}),
              icon_loop({{0.05f, -0.2f}, {-0.55f, 0.25f}, {-0.85f, 0.85f}, {-0.2f, 0.6f}, {0.25f, 0}})};
        },
    .first_of_group = true,
    .drag = Drag::kPath,
    .brush = 1,
    .selects = Selects::kPixels,
    .release =
        [](ToolHand& hand) {
          const Camera& camera = hand.context.pane_camera;
          hand.ask_region(
              brush_region(hand.state.path_px, hand.brush_px(), camera.width_px, camera.height_px),
              hand.state.path_px);
        },
    .shape = ToolShape::kPath,
};

constinit const Tool Tool::kLasso = {
    .name = "Lasso",
    .key = '6',
    .sentence = "Draw around Gaussians to select them by hand.",
    .icon = noose,
    .drag = Drag::kPath,
    .selects = Selects::kPixels,
    .release = [](ToolHand& hand) { ask_polygon(hand, hand.state.path_px); },
    .shape = ToolShape::kPolygon,
};

constinit const Tool Tool::kRectangle = {
    .name = "Rectangle",
    .key = '7',
    .sentence = "Drag a rectangle around Gaussians to select them by hand.",
    .icon = dashed_rectangle,
    .drag = Drag::kCorners,
    .selects = Selects::kPixels,
    .release =
        [](ToolHand& hand) {
          const Camera& camera = hand.context.pane_camera;
          const std::vector<glm::vec2>& corners = hand.state.path_px;
          if (corners.size() == 2)
            hand.ask_region(rectangle_region(corners[0], corners[1], camera.width_px, camera.height_px));
        },
    .shape = ToolShape::kRectangle,
};

constinit const Tool Tool::kPolygon = {
    .name = "Polygon",
    .key = '8',
    .sentence = "Click corners; Enter, a double-click or a click on the first corner closes the shape.",
    .icon = quadrangle,
    .selects = Selects::kPixels,
    .click = click_corner,
    .double_click = close_polygon,
    .confirm = confirm_polygon,
    .shape = ToolShape::kPolygon,
    .show =
        [](const ToolState& state, const Camera&, ToolOverlay* out) {
          out->dots = true;
          out->points_px = state.corners_px;
          if (!out->points_px.empty()) out->points_px.push_back(state.pointer_px);
        },
};

}  // namespace splatcut
