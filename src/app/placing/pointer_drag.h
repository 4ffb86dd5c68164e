// What a drag in the picture means in space.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "scene/camera/camera.h"

namespace splatcut {

// Cosine of the angle to the sight from which on a line counts as pointing at the camera.
inline constexpr float kEndOn = 0.97f;

// Pixel of a point before the camera.
inline glm::vec2 pixel_of(const Camera& camera, const glm::vec3& point_world) {
  return camera.pixel_from_camera(camera.camera_from_world(point_world));
}

// Direction of the pixel's ray, unit length, world.
inline glm::vec3 ray_through(const Camera& camera, const glm::vec2& pixel) {
  return glm::normalize(camera.world_from_pixel(pixel, 1) - camera.centre_world());
}

// Way of a point at that depth (scene units along the optical axis) that follows the pointer.
inline glm::vec3 way_at_depth(const Camera& camera, float depth, const glm::vec2& from_px,
                              const glm::vec2& to_px) {
  return camera.world_from_pixel(to_px, depth) - camera.world_from_pixel(from_px, depth);
}

// Distance along a line (axis_world of unit length) from its origin to the point that is nearest to the
// pixel's ray. A line that points at the camera counts as turned aside by kEndOn: the distance stays bounded.
inline float distance_along(const Camera& camera, const glm::vec3& origin_world, const glm::vec3& axis_world,
                            const glm::vec2& pixel) {
  constexpr float kLeast = 1 - kEndOn * kEndOn;
  const glm::vec3 ray = ray_through(camera, pixel), way = origin_world - camera.centre_world();
  const float cosine = glm::dot(axis_world, ray);
  return (cosine * glm::dot(ray, way) - glm::dot(axis_world, way)) / std::max(kLeast, 1 - cosine * cosine);
}

// Way along such a line of the point that follows the pointer.
inline float way_along(const Camera& camera, const glm::vec3& origin_world, const glm::vec3& axis_world,
                       const glm::vec2& from_px, const glm::vec2& to_px) {
  return distance_along(camera, origin_world, axis_world, to_px) -
         distance_along(camera, origin_world, axis_world, from_px);
}

}  // namespace splatcut
