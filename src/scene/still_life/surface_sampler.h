// Spreads oriented discs evenly over parametric surfaces.
//
// A Patch maps (u, v) in [0,1]^2 to the world. Samples follow the area element: a grid of cell areas gives
// the marginal distribution of v and the conditional one of u, through which a jittered Fibonacci lattice
// (k/n, k phi mod 1) is warped. That lattice stays well spaced under any stretch along its axes, so a long
// thin leaf is covered as evenly as a square table.
//
// SurfaceSample: position and unit frame (tangent_u, tangent_v, normal), world; sigma_u, sigma_v in scene
// units from the sample density: spacing = sqrt(area / n), sigma about overlap * spacing, limited to a
// fraction of the patch's own local width so that a splat does not hang over the edge of a thin strip. Normal
// direction: cross(dP/du, dP/dv). Cost: linear in the samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/job.h"

namespace splatcut {

inline constexpr float kTau = 6.28318531f;  // a whole turn

using SurfaceFn = std::function<glm::vec3(float u, float v)>;

struct SurfaceSample {
  glm::vec3 position{0}, tangent_u{1, 0, 0}, tangent_v{0, 1, 0}, normal{0, 0, 1};
  glm::vec2 uv{0};
  float sigma_u = 0, sigma_v = 0;
};

struct PatchShape {
  SurfaceFn surface;
  float overlap = 0.62f;                   // sigma as a part of the spacing
  float stretch = 1;                       // sigma_u / sigma_v wanted on average
  bool turn_randomly = true;               // false: discs stay aligned with u and v (grain, leaves)
  float limit_u = 0.22f, limit_v = 0.22f;  // largest sigma as a fraction of the local extent in u, v
  bool face_up = false;                    // turn the normal to the upper side (-y): two-sided sheets
  int cells_u = 24, cells_v = 24;          // resolution of the area grid, >= 1
};

// Surface area in square scene units, by the grid.
float patch_area(const PatchShape& shape);

// n samples; `stream` names the patch's own random numbers. Cancelled: unspecified.
std::vector<SurfaceSample> sample_patch(const PatchShape& shape, std::size_t n, std::uint64_t seed,
                                        std::uint64_t stream, const Job& job = {});

// Splits `total` in proportion to the weights (>= 0, at least one > 0 where total > 0), largest
// remainder first: the parts add up to total exactly.
std::vector<std::size_t> apportioned(std::span<const double> weights, std::size_t total);

// Surfaces. Heights grow towards -y (the world's up).
SurfaceFn parallelogram(const glm::vec3& origin, const glm::vec3& edge_u, const glm::vec3& edge_v);
// Polyline profile of (radius, height) turned about the vertical axis through base; corners are rounded
// by nothing, so give them points. Outward normals where the profile walks upwards on the outside.
SurfaceFn revolution(const glm::vec3& base, std::vector<glm::vec2> profile);
// Tube of the given radius along path(v). `side` must not be parallel to the path anywhere.
SurfaceFn tube(std::function<glm::vec3(float)> path, std::function<float(float)> radius,
               const glm::vec3& side);

}  // namespace splatcut
