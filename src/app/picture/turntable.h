// Cameras of the object turning once, for pictures, animation or video.
#pragma once

#include <vector>

#include "app/document/command.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

// Checks a command: throws Error if the number of frames, the size or the duration is out of range.
void check_turntable(const SaveTurntable& command);

// Cameras of one turn around the object, at the elevation of the front camera, which looks in the first one's
// direction. The whole object fits into each picture.
std::vector<Camera> cameras_of_turn(const ObjectExtent& extent, const Camera& front,
                                    const glm::vec3& up_world, const SaveTurntable& command);

}  // namespace splatcut
