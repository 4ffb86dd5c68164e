// Tools that set points on what is seen: the ground, and a length.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/tools/tool_hand.h"
#include "core/ranks.h"

namespace splatcut {

namespace {

// Where a ground lies below the pixel: a Gaussian alone in the air shows before, or through a gap behind, all
// that is around it, and the depth in the middle of that counts.
std::optional<glm::vec3> solid_point(const ToolHand& hand) {
  constexpr int kAround = 8;
  constexpr float kRadiusPoints = 14, kSameDepth = 0.02f;  // of the depth
  const Camera& camera = hand.context.pane_camera;
  const auto own = hand.context.pick(hand.at_px);
  if (!own) return {};
  std::vector<float> depths = {camera.camera_from_world(own->position_world).z};
  for (int i = 0; i < kAround; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / kAround;
    const glm::vec2 aside =
        kRadiusPoints * hand.context.pixels_per_point * glm::vec2(std::cos(angle), std::sin(angle));
    if (const auto depth = hand.context.depth(hand.at_px + aside)) depths.push_back(*depth);
  }
  const auto [least, most] = std::minmax_element(depths.begin() + 1, depths.end());
  const float slack = kSameDepth * depths.front();
  if (depths.size() < kAround / 2 || (depths.front() > *least - slack && depths.front() < *most + slack))
    return own->position_world;
  return camera.world_from_pixel(hand.at_px, median(depths));
}

void add_point(ToolHand& hand) {
  if (const auto point = hand.context.pick(hand.at_px))
    hand.state.points_world.push_back(point->position_world);
}

void show_points(const ToolState& state, const Camera& camera, ToolOverlay* out) {
  out->points_px.clear();
  for (const glm::vec3& point : state.points_world) {
    const glm::vec3 seen = camera.camera_from_world(point);
    if (seen.z > 0) out->points_px.push_back(camera.pixel_from_camera(seen));
  }
}

// The third says which way is up.
void click_ground(ToolHand& hand) {
  std::vector<glm::vec3>& points = hand.state.points_world;
  if (hand.state.right()) return points.clear();
  if (const auto point = solid_point(hand)) points.push_back(*point);
  if (points.size() < 3) return;
  // Of unit sides: how small the scene's numbers are does not matter.
  glm::vec3 up = glm::cross(glm::normalize(points[1] - points[0]), glm::normalize(points[2] - points[0]));
  // The ground is seen from above.
  if (glm::dot(up, hand.context.pane_camera.centre_world() - points[0]) < 0) up = -up;
  points.clear();
  hand.ask(SetUp{up});
}

void click_measure(ToolHand& hand) {
  if (hand.state.right() || hand.state.points_world.size() == 2) hand.state.points_world.clear();
  if (!hand.state.right()) add_point(hand);
}

Icon ruler() {
  Icon icon = {icon_loop({{-0.95f, 0.45f}, {0.45f, -0.95f}, {0.95f, -0.45f}, {-0.45f, 0.95f}})};
  for (const float t : {-0.45f, 0.0f, 0.45f})
    icon.push_back(icon_line({{-0.25f + t, -0.25f - t}, {-0.02f + t, -0.02f - t}}));
  return icon;
}

}  // namespace

constinit const Tool Tool::kGround = {
    .name = "Set up: three points of the ground",
    .key = '0',
    .sentence = "Click three points of the ground: that is where down is.",
    .hint = "click three points of the ground: {} of 3   right click: begin again",
    .icon =
        [] {
          return Icon{icon_loop({{-1, 0.55f}, {-0.3f, 0.15f}, {1, 0.35f}, {0.3f, 0.85f}}),
                      icon_line({{0, 0.5f}, {0, -0.9f}}),
                      icon_line({{-0.25f, -0.6f}, {0, -0.9f}, {0.25f, -0.6f}})};
        },
    .first_of_group = true,
    .click = click_ground,
    .shape = ToolShape::kPoints,
    .show =
        [](const ToolState& state, const Camera& camera, ToolOverlay* out) {
          show_points(state, camera, out);
          out->counted = true;
        },
};

constinit const Tool Tool::kMeasure = {
    .name = "Measure between two points",
    .key = 'K',
    .sentence = "Click two points: how far they are apart.",
    .hint = "click two points   right click: begin again",
    .icon = ruler,
    .click = click_measure,
    .shape = ToolShape::kPoints,
    .show =
        [](const ToolState& state, const Camera& camera, ToolOverlay* out) {
          show_points(state, camera, out);
          if (state.points_world.size() == 2)
            out->length = glm::distance(state.points_world[0], state.points_world[1]);
        },
};

}  // namespace splatcut
