// The convex hull of Gaussians, few corners for a physics engine.
//
// In: a cloud and flags of the Gaussians to keep. Out: corners and triangles in the cloud's frame and units.
// The hull is that of ellipsoids, one standard deviation large: for directions spread over the sphere, the
// point of all ellipsoids that lies farthest (the support point, c + S d / sqrt(d S d) with S the
// covariance), and Qhull's triangles around these points. So it lies within the hull of the ellipsoids,
// touches it in each direction, and has no more corners than directions. Gaussians of an opacity below a
// tenth have no say: dust that nobody sees would make the hull larger.
//
// Source: C. B. Barber, D. P. Dobkin, H. Huhdanpaa, The Quickhull Algorithm for Convex Hulls, 1996
// (libqhull).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct ConvexHull {
  std::vector<glm::vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // corners, counterclockwise seen from outside
};

constexpr int kHullDirections = 250;  // engines commonly hold 255 corners

// keep: 0 or 1 per Gaussian, empty: all. Throws Error where there is no volume: fewer than four Gaussians
// that can be seen and are points, or all in a plane.
ConvexHull convex_hull(const GaussianCloud& cloud, std::span<const std::uint8_t> keep,
                       int directions = kHullDirections);

// As a Wavefront .obj: a line "v x y z" each corner, moved by `origin`, then "f a b c" each triangle, counted
// from 1.
std::string obj_text(const ConvexHull& hull, const glm::dvec3& origin = glm::dvec3(0));

}  // namespace splatcut
