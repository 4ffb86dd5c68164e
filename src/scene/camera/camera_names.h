// Which camera a name means: cameras are called after pictures, and tools write those names in many ways.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

// A picture's name without its ending; "view.001" is a whole name.
std::string without_picture_ending(const std::filesystem::path& name);

// Each camera's picture, a path with / or \, becomes the camera's name: without folders and ending where no
// two cameras would be called alike, else the path below a folder `images`, without ending.
void name_after_pictures(std::vector<Camera>* cameras);

// The cameras, by index, that a picture's name means, both with or without an ending: those of the same path;
// else of the same path from some folder on; else of the same file name. Where none is, the same without
// regard to case.
std::vector<std::size_t> cameras_named(const std::vector<Camera>& cameras, const std::string& name);

// The same of a mask's name, which may differ in more: _mask and its like at its end or beginning, other
// numbers of zeros before a last number, accents written as macOS does.
std::vector<std::size_t> cameras_of_mask(const std::vector<Camera>& cameras, const std::string& name);

// Whether the name says that the picture is a mask.
bool is_called_mask(const std::filesystem::path& picture);

// Throws Error, naming `where`, for a name of none or of several. A number from 0 counts the cameras where
// none is called so; with zeros before it, it is a name.
const Camera& find_camera(const std::vector<Camera>& cameras, const std::string& name,
                          const std::string& where);

}  // namespace splatcut
