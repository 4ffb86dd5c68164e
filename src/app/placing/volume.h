// A sphere or a box in space that selects, and the handles by which the pointer changes it.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

// A sphere or a box. Lengths are in scene units.
struct Volume {
  bool round = true;  // true: sphere, false: box
  glm::vec3 centre_world{0};
  glm::vec3 half{0};                     // halves of a box's sides, > 0; a sphere has its radius in half.x
  glm::quat world_from_box{1, 0, 0, 0};  // axes of a box
};

bool inside(const Volume& volume, const glm::vec3& point_world);

// Pixels of the handles; empty if one of them would be behind the camera. Handle 0 moves the volume. The
// others change its size: handle 1 of a sphere; handles 1 to 6 of a box, one per face (+x, -x, +y, ...).
std::vector<glm::vec2> handles_px(const Volume& volume, const Camera& camera);
using Edges = std::vector<std::pair<glm::vec2, glm::vec2>>;  // both ends of each edge, pixels
Edges edges_px(const Volume& volume, const Camera& camera);  // edges of a box

// The volume after a handle went from one pixel to another.
Volume dragged(const Volume& volume, std::size_t handle, const glm::vec2& from_px, const glm::vec2& to_px,
               const Camera& camera);

}  // namespace splatcut
