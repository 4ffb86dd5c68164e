// Where somebody looks from, as work files keep it: COLMAP axes, scene units.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace splatcut {

struct CameraPose {
  glm::quat camera_from_world{1, 0, 0, 0};
  glm::vec3 position_world{0};
  float distance = 4;             // to the pivot, scene units
  float fov_y_rad = 0.87266463f;  // 50 degrees, as on the command line

  bool operator==(const CameraPose&) const = default;
};

}  // namespace splatcut
