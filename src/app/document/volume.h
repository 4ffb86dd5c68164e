// A sphere or a box in space that selects, and the handles by which the pointer changes it.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

// Lengths in scene units. A sphere has its radius in half.x; a box its own axes.
struct Volume {
  bool round = true;
  glm::vec3 centre_world{0};
  glm::vec3 half{0};  // of the sides, > 0
  glm::quat world_from_box{1, 0, 0, 0};
};

bool inside(const Volume& volume, const glm::vec3& point_world);

// Where they are in the picture; none where one would be behind the camera. Handle 0 moves the whole, the
// others change its size: of a sphere 1, of a box 1 to 6, a face each (+x, -x, +y, ...).
std::vector<glm::vec2> handles_px(const Volume& volume, const Camera& camera);
using Edges = std::vector<std::pair<glm::vec2, glm::vec2>>;
Edges edges_px(const Volume& volume, const Camera& camera);  // of a box

// The volume after a handle went from one pixel to another.
Volume dragged(const Volume& volume, std::size_t handle, const glm::vec2& from_px, const glm::vec2& to_px,
               const Camera& camera);

}  // namespace splatcut
