// Cameras of a made capture, as trainers write them.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

// cameras.json of Inria's trainer. Throws Error if it cannot be written.
void save_inria_cameras(const std::filesystem::path& path, const std::vector<Camera>& cameras);

}  // namespace splatcut
