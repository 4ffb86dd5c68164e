// Cameras around an object, where the scene brings none.
#pragma once

#include <span>
#include <vector>

#include "scene/camera.h"
#include "scene/gaussian_cloud.h"

namespace splatcut {

struct ObjectExtent {
  glm::vec3 centre_world{0};
  float radius = 0;  // scene units; holds nearly all of the object
};

// Centre and radius of the labelled Gaussians, tails of 2 % left out.
ObjectExtent object_extent(const GaussianCloud& cloud, std::span<const std::uint8_t> labels);

struct OrbitOptions {
  int views = 12;                 // without the reference
  float distance_sizes = 1.6f;    // distance over object size (2 radius)
  float elevation_swing_rad = 0.1745f;  // alternately above and below the reference's elevation
};

// Cameras on a circle about the object's centre, around the reference's up axis, in order outward from
// the reference: +1, -1, +2, -2, ... steps. Same picture size as the reference.
std::vector<Camera> orbit_cameras(const Camera& reference, const glm::vec3& up_world, const ObjectExtent& object,
                                  const OrbitOptions& options);

}  // namespace splatcut
