// Cameras of a capture: Inria cameras.json, COLMAP (folder with cameras/images .txt or .bin),
// NeRF transforms.json. All become world->camera, x right, y down, z forward.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

// By name and content. Throws Error naming file and entry.
// warning, if given: a sentence where the lenses are distorted, which is left out here (everything is drawn
// through a pinhole); empty otherwise.
// origin: taken off their positions before these are rounded to 32 bits, as off those of the scene
// (Scene::origin).
std::vector<Camera> load_cameras(const std::filesystem::path& path, std::string* warning = nullptr,
                                 const glm::dvec3& origin = glm::dvec3(0));

}  // namespace splatcut
