#include "app/placing/placing_handles.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/placing/pointer_drag.h"

namespace splatcut {

namespace {

constexpr float kArrowShare = 0.74f, kScaleShare = 1.2f;  // of the reach: arrows; the way to the square

float depth_of(const PlacingHandles& handles, const Camera& camera) {
  return camera.camera_from_world(handles.centre_world).z;
}

float reach_world(const PlacingHandles& handles, const Camera& camera) {
  return handles.reach_px * depth_of(handles, camera) / camera.fy_px;
}

// Two directions that make a right-handed frame with the axis.
std::pair<glm::vec3, glm::vec3> across(const glm::vec3& axis) {
  const glm::vec3 other = std::abs(axis.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(glm::cross(other, axis));
  return {u, glm::cross(axis, u)};
}

std::vector<glm::vec3> ring_world(const PlacingHandles& handles, const glm::vec3& axis,
                                  const Camera& camera) {
  constexpr int kSteps = 32;
  constexpr float kFromTheFront = 0.96f;
  const float radius = reach_world(handles, camera);
  const auto [u, v] = across(axis);
  const glm::vec3 to_camera = glm::normalize(camera.centre_world() - handles.centre_world);
  const bool whole = std::abs(glm::dot(axis, to_camera)) > kFromTheFront;
  const float towards = std::atan2(glm::dot(v, to_camera), glm::dot(u, to_camera));
  const float half = whole ? glm::pi<float>() : glm::half_pi<float>();
  std::vector<glm::vec3> points;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = towards + half * (2 * static_cast<float>(i) / kSteps - 1);
    points.push_back(handles.centre_world + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return points;
}

// A ball or square is more than its middle: rings pass before it.
float distance_to(const std::vector<glm::vec2>& path, const glm::vec2& at) {
  constexpr float kKnob = 6;
  if (path.size() == 1) return std::max(0.0f, glm::distance(path[0], at) - kKnob);
  float least = glm::distance(path.front(), at);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const glm::vec2 way = path[i + 1] - path[i];
    const float length2 = glm::dot(way, way);
    const float t = length2 > 0 ? glm::clamp(glm::dot(at - path[i], way) / length2, 0.0f, 1.0f) : 0;
    least = std::min(least, glm::distance(path[i] + t * way, at));
  }
  return least;
}

// Where the pixel's ray meets the ring's plane; none where it grazes the plane or leaves it behind.
std::optional<glm::vec3> on_plane(const PlacingHandles& handles, const glm::vec3& axis, const Camera& camera,
                                  const glm::vec2& pixel) {
  constexpr float kGrazes = 0.2f;
  const glm::vec3 ray = ray_through(camera, pixel);
  const float steep = glm::dot(axis, ray);
  if (std::abs(steep) < kGrazes) return {};
  const float distance = glm::dot(axis, handles.centre_world - camera.centre_world()) / steep;
  if (distance <= 0) return {};
  return camera.centre_world() + distance * ray - handles.centre_world;
}

// By the angle between two places on the plane; along the ring, where that is seen from its edge.
float turned(const PlacingHandles& handles, const glm::vec3& axis, const Camera& camera,
             const glm::vec2& from_px, const glm::vec2& to_px) {
  const auto from = on_plane(handles, axis, camera, from_px), to = on_plane(handles, axis, camera, to_px);
  if (from && to) return std::atan2(glm::dot(axis, glm::cross(*from, *to)), glm::dot(*from, *to));
  const std::vector<glm::vec3> ring = ring_world(handles, axis, camera);
  const auto far = [&](const glm::vec3& p) { return glm::distance(pixel_of(camera, p), from_px); };
  const glm::vec3 at = *std::ranges::min_element(ring, {}, far);
  constexpr float kSmall = 0.01f;  // rad
  const glm::vec3 ahead = handles.centre_world + glm::angleAxis(kSmall, axis) * (at - handles.centre_world);
  const glm::vec2 per_rad = (pixel_of(camera, ahead) - pixel_of(camera, at)) / kSmall;
  const float angle = glm::dot(to_px - from_px, per_rad) / std::max(1e-6f, glm::dot(per_rad, per_rad));
  return std::remainder(angle, glm::two_pi<float>());
}

}  // namespace

std::vector<PlacingHandle> handles_px(const PlacingHandles& handles, const Camera& camera) {
  constexpr float kFromMiddle = 0.16f;  // of the reach: arrows begin beside the ball
  std::vector<PlacingHandle> shown;
  if (!(depth_of(handles, camera) > 1e-6f)) return shown;
  const float reach = reach_world(handles, camera);
  const glm::vec2 middle = pixel_of(camera, handles.centre_world);
  const glm::vec3 sight = glm::normalize(handles.centre_world - camera.centre_world());
  for (std::size_t i = 0; i < handles.turn_axes.size(); ++i) {
    PlacingHandle ring{PlacingGrip::kTurn, i, {}};
    for (const glm::vec3& p : ring_world(handles, handles.turn_axes[i], camera))
      if (camera.camera_from_world(p).z > 0) ring.path_px.push_back(pixel_of(camera, p));
    if (ring.path_px.size() > 1) shown.push_back(std::move(ring));
  }
  for (std::size_t i = 0; i < handles.arrow_axes.size(); ++i) {
    const glm::vec3& axis = handles.arrow_axes[i];
    const glm::vec3 tip = handles.centre_world + kArrowShare * reach * axis;
    if (std::abs(glm::dot(axis, sight)) > kEndOn || !(camera.camera_from_world(tip).z > 0)) continue;
    shown.push_back(
        {PlacingGrip::kMoveAlong,
         i,
         {pixel_of(camera, handles.centre_world + kFromMiddle * reach * axis), pixel_of(camera, tip)}});
  }
  const float aside = kScaleShare * handles.reach_px * glm::one_over_root_two<float>();
  shown.push_back({PlacingGrip::kScale, 0, {middle + glm::vec2(aside, -aside)}});
  shown.push_back({PlacingGrip::kMove, 0, {middle}});
  return shown;
}

std::optional<std::size_t> handle_at(std::span<const PlacingHandle> shown, const glm::vec2& at_px,
                                     float within_px) {
  std::optional<std::size_t> nearest;
  float least = within_px;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float distance = distance_to(shown[i].path_px, at_px);
    if (distance > least) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

PlacingChange dragged(const PlacingHandles& handles, const PlacingHandle& handle, const glm::vec2& from_px,
                      const glm::vec2& to_px, const Camera& camera, bool in_steps) {
  constexpr float kLeastScale = 0.02f, kScaleStep = 0.1f, kTurnStep = glm::pi<float>() / 12;
  PlacingChange change;
  switch (handle.grip) {
    case PlacingGrip::kMove:
      change.move_world = way_at_depth(camera, depth_of(handles, camera), from_px, to_px);
      break;
    case PlacingGrip::kMoveAlong: {
      const glm::vec3& axis = handles.arrow_axes[handle.axis];
      change.move_world = way_along(camera, handles.centre_world, axis, from_px, to_px) * axis;
      break;
    }
    case PlacingGrip::kTurn: {
      const glm::vec3& axis = handles.turn_axes[handle.axis];
      change.angle_rad = turned(handles, axis, camera, from_px, to_px);
      if (in_steps) {
        const float before =
            handle.axis < handles.turned_deg.size() ? glm::radians(handles.turned_deg[handle.axis]) : 0;
        change.angle_rad = kTurnStep * std::round((before + change.angle_rad) / kTurnStep) - before;
      }
      change.turn = glm::angleAxis(change.angle_rad, axis);
      break;
    }
    case PlacingGrip::kScale: {
      const glm::vec2 middle = pixel_of(camera, handles.centre_world);
      change.scale = glm::distance(to_px, middle) / std::max(1.0f, glm::distance(from_px, middle));
      if (in_steps) {
        const float whole = kScaleStep * std::round(handles.scaled * change.scale / kScaleStep);
        change.scale = std::max(kScaleStep, whole) / handles.scaled;
      }
      change.scale = std::max(kLeastScale, change.scale);
      break;
    }
  }
  return change;
}

}  // namespace splatcut
