// A grid on the ground of the scene, by which the user judges size and level.
//
// The plane is perpendicular to up. Of the Gaussians within the scene's robust bounds, kBelowShare lie below
// it, so that a table on a floor is not taken for the ground; or more, where what lies below is no floaters
// but the foot of a thing. The grid is as wide as the scene; around a thing that stands alone twice as wide
// as that is wide or high. Cells are 1, 2 or 5 times a power of ten, 8 to 20 across it; as_seen_by() makes
// them smaller when the eye comes near the ground. Lines lie at multiples of the cell from the world's
// origin, along the two world axes that come nearest to the ground, so that in an upright scene the coloured
// lines are the axes themselves. Not handled: ground that slopes. Where it rises above the plane by more than
// `rough`, it hides the grid.
#pragma once

#include <optional>
#include <vector>

#include "app/picture/picture_depth.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct GroundGrid {
  glm::vec3 origin_world{0};                // origin of the world, projected along up to the ground
  glm::vec3 up_world{0}, along_world[2]{};  // unit vectors, perpendicular to each other
  int axis[2] = {0, 1};                     // world axes that along_world follows: 0 x, 1 y, 2 z
  float cell = 1;                           // side of a cell, scene units
  float rough = 0;                          // height up to which ground does not hide the grid, scene units
  glm::ivec2 first{0}, last{0};             // first and last line each way, in cells from the origin
  glm::vec3 point_world(float i, float j) const {
    return origin_world + cell * (i * along_world[0] + j * along_world[1]);
  }
};

// The largest of 1, 2 and 5 times a power of ten that is at most `length`. length: > 0.
float round_length_below(float length);

// Height of the ground above the world's origin, along up, scene units. up_world: unit length.
float ground_height(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world);

// The grid of a scene. bounds: the scene's robust bounds.
GroundGrid ground_grid(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world);

// Returns the scene's grid, or a finer one on the ground before the camera if the scene's cells are large
// beside the height of the eye above the ground.
GroundGrid as_seen_by(const GroundGrid& of_scene, const Camera& camera);

// A piece of a grid line in the picture.
struct GridPiece {
  glm::vec2 from_px, to_px;
  float opacity;            // opacity in [0, 1]; it falls towards the grid's border and where lines crowd
  std::optional<int> axis;  // world axis that the line lies on; none: the line misses the origin
};

// The pieces of the grid that show: not hidden by anything that rises above the ground by more than `rough`.
// Cost: one question to `depth` every kStepPx pixels of line.
std::vector<GridPiece> pieces_in_view(const GroundGrid& grid, const Camera& camera, const DrawLimits& limits,
                                      const PictureDepth& depth);

}  // namespace splatcut
