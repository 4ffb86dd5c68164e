// The plane that an object stands on, hangs on or leans against, found among what surrounds it.
//
// RANSAC (Fischler and Bolles 1981): planes through three points of what surrounds the object; one counts
// where the object lies on one side of it and its lowest part that is seen is near it. Its worth is the
// number of points within .02 of the object's radius of it, those near the object counting more; it is worth
// less the farther it lies below the object, and where it is a wall or a ceiling. The best is fitted to its
// points. Same input, same plane.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "segment/superpoints/orbit.h"

namespace splatcut {

struct SupportPlane {
  glm::vec3 point_world{0};   // below the object's centre
  glm::vec3 normal_world{0};  // unit, towards the object
  float share = 0;            // of what surrounds the object, points by their nearness, that lies in it
  float height(const glm::vec3& world) const { return glm::dot(world - point_world, normal_world); }
};

// Points on the surface of the object and of the rest, at most a few thousand of each are looked at; up is a
// unit vector. None: nothing flat touches the object.
std::optional<SupportPlane> support_plane(const std::vector<glm::vec3>& on_object,
                                          const std::vector<glm::vec3>& on_rest, const ObjectExtent& object,
                                          const glm::vec3& up_world);

}  // namespace splatcut
