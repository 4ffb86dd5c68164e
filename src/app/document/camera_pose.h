// Pose of the user's camera, as work files keep it: COLMAP axes (x right, y down, z forward), scene units.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace splatcut {

struct CameraPose {
  glm::quat camera_from_world{1, 0, 0, 0};
  glm::vec3 position_world{0};
  float distance = 4;             // distance to the pivot, scene units
  float fov_y_rad = 0.87266463f;  // vertical field of view: 50 degrees, the default of the command line

  bool operator==(const CameraPose&) const = default;
};

}  // namespace splatcut
