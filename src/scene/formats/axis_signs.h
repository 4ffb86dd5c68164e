// The axes of scene files whose axes differ from ours (x right, y down, z forward, as in a .ply) by signs
// alone.
//
// A point p of the file is (x p.x, y p.y, z p.z) here. A quaternion's axis is a cross product of two
// vectors, so each of its components takes the signs of the other two axes; a mirrored Gaussian looks the
// same, as it is symmetric in its own axes. A spherical harmonic takes the signs of the coordinates it is a
// product of.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace splatcut {

struct AxisSigns {
  float x = 1, y = 1, z = 1;

  glm::vec3 position(const glm::vec3& p) const { return {x * p.x, y * p.y, z * p.z}; }
  glm::quat rotation(const glm::quat& q) const { return {q.w, y * z * q.x, x * z * q.y, x * y * q.z}; }
  // Of the coefficients of degree 1, 2 and 3, in the order of f_rest.
  constexpr std::array<float, 15> sh() const {
    return {y, z, x, x * y, y * z, 1, x * z, 1, y, x * y * z, y, z, x, z, x};
  }
};

inline constexpr AxisSigns kRightUpBack{1, -1, -1};    // OpenGL, three.js, .spz by its own text
inline constexpr AxisSigns kLeftUpForward{-1, -1, 1};  // glTF

}  // namespace splatcut
