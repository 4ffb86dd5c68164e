// Internal to src/segment (.cpp files).
#pragma once

#include <glm/glm.hpp>

namespace splatcut {

inline float squared_distance(const glm::vec3& a, const glm::vec3& b) {
  return glm::dot(a - b, a - b);
}

}  // namespace splatcut
