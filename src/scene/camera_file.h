// Cameras of a capture: Inria cameras.json, COLMAP (folder with cameras/images .txt or .bin),
// NeRF transforms.json. All become world->camera, x right, y down, z forward.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/camera.h"

namespace splatcut {

// By name and content. Throws Error naming file and entry.
std::vector<Camera> load_cameras(const std::filesystem::path& path);

void save_inria_cameras(const std::filesystem::path& path, const std::vector<Camera>& cameras);

}  // namespace splatcut
