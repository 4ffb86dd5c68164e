// Cameras of the object turning once, for pictures, animation or video.
#pragma once

#include <vector>

#include "app/document/command.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

// Throws Error for a number of frames, a size or a time that cannot be.
void check_turntable(const SaveTurntable& command);

// Once round the object at the front camera's own elevation, from where the user stands.
std::vector<Camera> cameras_of_turn(const ObjectExtent& extent, const Camera& front,
                                    const glm::vec3& up_world, const SaveTurntable& command);

}  // namespace splatcut
