// Cameras around an object: where to look from, after the first view.
//
// A scene without cameras, or one that was photographed from all around, is looked at from a circle about the
// object; one photographed from one side only from a spiral on that side (Jain et al., GaussianCut, 2024:
// circle for 360-degree scenes, spiral for front-facing ones). Distance follows from the object's size; the
// paper's follows from the photographs and shows small objects with few pixels.
#pragma once

#include <span>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct ObjectExtent {
  glm::vec3 centre_world{0};
  float radius = 0;  // scene units; holds nearly all of the object
};

// Centre and radius of the labelled Gaussians' positions, tails of 2 % left out; where these are one point,
// the radius is three times the largest standard deviation.
ObjectExtent object_extent(const GaussianCloud& cloud, std::span<const std::uint8_t> labels);

inline constexpr int kViewsAround = 12;

struct OrbitOptions {
  int views = kViewsAround;             // without the reference
  float distance_sizes = 1.6f;          // distance over object size (2 radius)
  float elevation_swing_rad = 0.1745f;  // alternately above and below the reference's elevation
  bool operator==(const OrbitOptions&) const = default;
};

// Cameras on a circle about the object's centre, around the reference's up axis, in order outward from
// the reference: +1, -1, +2, -2, ... steps. Same picture size as the reference.
std::vector<Camera> orbit_cameras(const Camera& reference, const glm::vec3& up_world,
                                  const ObjectExtent& object, const OrbitOptions& options);

// True for a front-facing capture: all cameras look within about 45 degrees of their mean direction.
bool front_facing(std::span<const Camera> given);

// orbit_cameras, or for a front-facing capture a spiral of two turns within the given positions' spread about
// the reference; for given cameras around the object, their median elevation instead of the reference's.
// Outward from the reference, with_room(). given: of the scene's photographs, may be empty.
std::vector<Camera> cameras_around(const Camera& reference, const glm::vec3& up_world,
                                   const ObjectExtent& object, std::span<const Camera> given,
                                   const OrbitOptions& options);

// The camera with a near plane that leaves the object whole, where the cloud's would cut into it: that of a
// scene with a sky lies farther away than a small object.
Camera with_room(const Camera& camera, const ObjectExtent& object);

// The camera nearer to the point: at `share` of its distance.
Camera approached(const Camera& camera, const glm::vec3& point_world, float share);

}  // namespace splatcut
