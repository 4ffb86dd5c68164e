// Placement of exported Gaussians in their file: recentred, turned upright, turned, scaled and moved.
//
// In: a cloud, flags for the Gaussians to keep, the numbers of a placement. Out: p' = scale R (p - origin) +
// move, with rotations, standard deviations and spherical harmonics changed to match. Each band of harmonics
// turns by the matrix that agrees with the turned functions in as many directions as the band has
// coefficients; a band is closed under rotations, so the matrix then agrees in all directions. Cost: one
// pass, about 1 us a Gaussian of degree 3.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "app/placing/placing_handles.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/formats/axis_signs.h"

namespace splatcut {

// Point that becomes 0, 0, 0 of the file: the scene's origin, the middle of the kept Gaussians, or the foot
// below that middle.
enum class ExportOrigin { kScene, kCentre, kFoot };
// Direction in the file to which the document's up turns; kScene: no turn.
enum class ExportUp { kScene, kPlusY, kMinusY, kPlusZ };

struct ExportPlacement {
  ExportOrigin origin = ExportOrigin::kScene;
  ExportUp up = ExportUp::kScene;
  float turn_deg = 0;  // angle about that up, counterclockwise seen from above
  float scale = 1;     // factor > 0
  glm::vec3 move{0};   // translation after all else, scene units
  bool operator==(const ExportPlacement&) const = default;
};

// The words that options and requests have for them, in the order of the enumerators.
inline constexpr std::array<const char*, 3> kOriginNames = {"scene", "centre", "foot"};
inline constexpr std::array<const char*, 4> kUpNames = {"scene", "+y", "-y", "+z"};
// Throws Error for a word that is none of them.
ExportPlacement placement_by_name(std::string_view origin, std::string_view up);

// Similarity transform p' = scale rotation (p - origin) + move.
struct Similarity {
  glm::quat rotation{1, 0, 0, 0};
  float scale = 1;
  glm::vec3 origin{0}, move{0};
};
glm::vec3 moved(const glm::vec3& point, const Similarity& to);
// The shortest rotation from one direction to another. Both may have any length but 0. If they are opposite,
// the axis is some perpendicular.
glm::quat turn_between(const glm::vec3& from, const glm::vec3& to);

// The part of a placement that needs a pass over all Gaussians. It depends on `origin` and `up` of the
// placement, but not on its turn, scale and move.
struct ExportFrame {
  glm::vec3 up_file{0, 1, 0};     // up direction in the file, unit length
  glm::quat upright{1, 0, 0, 0};  // rotation from the document's up to up_file
  glm::vec3 origin_world{0};      // point that the placement carries to `move`
  glm::vec3 middle_world{0};      // middle of the kept Gaussians
};
// keep: 0 or 1 per Gaussian, empty: all; outliers do not count for middle and foot. up_world: the document's
// up. axes: axes of the file format, in which ExportPlacement::up is meant; all other numbers have the axes
// of a .ply.
ExportFrame export_frame(const ExportPlacement& placement, const GaussianCloud& cloud,
                         std::span<const std::uint8_t> keep, const glm::vec3& up_world,
                         const AxisSigns& axes = {});
Similarity similarity_of(const ExportPlacement& placement, const ExportFrame& frame);
Similarity similarity_of(const ExportPlacement& placement, const GaussianCloud& cloud,
                         std::span<const std::uint8_t> keep, const glm::vec3& up_world,
                         const AxisSigns& axes = {});

// Point of the file around which handles turn and scale: the chosen origin, or the middle of the kept
// Gaussians if the origin is the scene's.
glm::vec3 pivot_of(const ExportPlacement& placement, const ExportFrame& frame);
// The placement after a drag of handles around that pivot. change: its turn is about up_file.
ExportPlacement changed(ExportPlacement placement, const glm::vec3& pivot_file, const PlacingChange& change);

// Returns the kept Gaussians alone, in their order, transformed. keep: 0 or 1 per Gaussian; empty: all.
GaussianCloud placed(const GaussianCloud& cloud, std::span<const std::uint8_t> keep, const Similarity& to);

}  // namespace splatcut
