// The up direction of a scene, from the cameras of its capture.
//
// People hold cameras level or on their side, and turn and tilt them. So one of the two axes of the pictures
// stays in the ground plane, in all views: up is the direction that it avoids,
//   up = eigenvector of sum_i a_i a_i^T / n to the least eigenvalue e1, a_i the right axis of camera i, or
//   its down axis if pictures lie on their side. e1 = mean sin^2 of the angles out of the plane.
// That holds however far the cameras look down, where the mean of their up axes leans away from the side on
// which they stand. The plane is known if sqrt(e1 / (n e2)), the error of its tilt in radians, is small; e2
// is the middle eigenvalue. Else up is the mean of the up axes, or of the right axes if these agree more.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "scene/camera/camera.h"

namespace splatcut {

// Unit vector in world coordinates; (0, -1, 0) for no cameras, and where they agree on nothing.
glm::vec3 common_up(std::span<const Camera> cameras);

}  // namespace splatcut
