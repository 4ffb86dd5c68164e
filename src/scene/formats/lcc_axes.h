// Axes of .lcc and LCC2: x right, y forward, z up; to ours by a quarter turn about x. Internal to
// src/scene/formats.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/cloud/spherical_harmonics.h"

namespace splatcut {

inline const glm::quat kLccUpright(0.70710678f, 0.70710678f, 0, 0);
inline glm::vec3 lcc_turned(const glm::vec3& p) {
  return {p.x, -p.z, p.y};
}

}  // namespace splatcut
