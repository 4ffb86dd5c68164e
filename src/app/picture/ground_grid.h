// A grid on the ground of the scene, to judge size and level by.
//
// The plane is perpendicular to up, through the height below which kBelowShare of the Gaussians lie, of those
// within the scene's robust bounds: a table that stands on a floor is not the ground. Cells are 1, 2 or 5
// times a power of ten, 8 to 20 across the scene; from within a scene smaller ones, before the eye, as the
// eye comes near the ground. Lines lie at multiples of the cell from the world's origin, along those of the
// world's axes that come nearest to the ground, so that with an upright scene the coloured lines are the axes
// themselves. Not handled: ground that slopes. Where it rises above the plane by more than `rough`, it hides
// the grid.
#pragma once

#include <optional>
#include <vector>

#include "app/picture/picture_depth.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct GroundGrid {
  glm::vec3 origin_world{0};                // the world's origin, carried down or up to the ground
  glm::vec3 up_world{0}, along_world[2]{};  // unit, perpendicular to each other
  int axis[2] = {0, 1};                     // of the world, that along_world follows: 0 x, 1 y, 2 z
  float cell = 1;                           // scene units
  float rough = 0;                          // how far what stands on the ground rises at least, scene units
  glm::ivec2 first{0}, last{0};             // lines, cells from the origin
  glm::vec3 point_world(float i, float j) const {
    return origin_world + cell * (i * along_world[0] + j * along_world[1]);
  }
};

// The largest of 1, 2, 5 times a power of ten that is no more than `length`.
float round_length_below(float length);

// The height of the ground above the world's origin, along up.
float ground_height(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world);

GroundGrid ground_grid(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world);

// The same, or a finer one around the ground before the camera where the scene's cells are large beside the
// eye's height above them.
GroundGrid as_seen_by(const GroundGrid& of_scene, const Camera& camera);

// A piece of a line, as it shows.
struct GridPiece {
  glm::vec2 from_px, to_px;
  float opacity;            // [0, 1]: less to the sides, and where lines come close together
  std::optional<int> axis;  // of the world, if the line goes through the origin
};

// What shows of the grid, without what stands before it and rises above the ground.
// Cost: a question to `depth` every kStepPx pixels of line.
std::vector<GridPiece> pieces_in_view(const GroundGrid& grid, const Camera& camera, const DrawLimits& limits,
                                      const PictureDepth& depth);

}  // namespace splatcut
