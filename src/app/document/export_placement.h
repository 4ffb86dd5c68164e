// Where exported Gaussians stand in their file: recentred, turned upright, turned, scaled, moved.
//
// In: a cloud, which of its Gaussians are kept, numbers. Out: p' = scale R (p - origin) + move, with the
// rotations, standard deviations and spherical harmonics that belong to it. Bands of harmonics turn by the
// matrix that agrees with the turned functions in as many directions as a band has coefficients (a band is
// closed under rotations, so that it then agrees in all). Cost: one pass, about 1 us a Gaussian of degree 3.
#pragma once

#include <cstdint>
#include <span>

#include "app/document/placing_handles.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/formats/axis_signs.h"

namespace splatcut {

enum class ExportOrigin { kScene, kCentre, kFoot };  // of the scene; the middle of what is kept; below it
enum class ExportUp { kScene, kPlusY, kMinusY, kPlusZ };  // where the document's up points in the file

struct ExportPlacement {
  ExportOrigin origin = ExportOrigin::kScene;
  ExportUp up = ExportUp::kScene;
  float turn_deg = 0;  // about that up, counterclockwise seen from above
  float scale = 1;     // > 0
  glm::vec3 move{0};   // scene units, after all else
  bool operator==(const ExportPlacement&) const = default;
};

// p' = scale rotation (p - origin) + move.
struct Similarity {
  glm::quat rotation{1, 0, 0, 0};
  float scale = 1;
  glm::vec3 origin{0}, move{0};
};
glm::vec3 moved(const glm::vec3& point, const Similarity& to);
// The shortest turn from one direction to another, of any lengths but 0; where they are opposite, about some
// axis across.
glm::quat turn_between(const glm::vec3& from, const glm::vec3& to);

// What of a placement takes a look at all Gaussians: its numbers have no say.
struct ExportFrame {
  glm::vec3 up_file{0, 1, 0};     // unit length
  glm::quat upright{1, 0, 0, 0};  // from the document's up to that
  glm::vec3 origin_world{0};      // what `move` says the place of
  glm::vec3 middle_world{0};      // of what is kept
};
// keep: 0 or 1 per Gaussian; outliers do not count for its middle and its foot. up_world: the document's.
// axes: the file's, which `up` is of; all other numbers are of a .ply's.
ExportFrame export_frame(const ExportPlacement& placement, const GaussianCloud& cloud,
                         std::span<const std::uint8_t> keep, const glm::vec3& up_world,
                         const AxisSigns& axes = {});
Similarity similarity_of(const ExportPlacement& placement, const ExportFrame& frame);
Similarity similarity_of(const ExportPlacement& placement, const GaussianCloud& cloud,
                         std::span<const std::uint8_t> keep, const glm::vec3& up_world,
                         const AxisSigns& axes = {});

// In the file: what turns and scales with handles leave where it is. The origin, where it was chosen; the
// middle of what is kept, where the scene's was.
glm::vec3 pivot_of(const ExportPlacement& placement, const ExportFrame& frame);
// After a drag of handles around that pivot, which turn about up_file alone.
ExportPlacement changed(ExportPlacement placement, const glm::vec3& pivot_file, const PlacingChange& change);

// Those Gaussians alone, in their order, as the similarity has them.
GaussianCloud placed(const GaussianCloud& cloud, std::span<const std::uint8_t> keep, const Similarity& to);

}  // namespace splatcut
