// Masks that another tool made: read, checked against their camera, found by its name.
//
// A mask is a PNG of any kind, half bright or brighter = object. Throws Error for what cannot be used:
// unreadable, of another size than the camera's picture, without a bright pixel, of no camera or of several.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/camera/camera.h"
#include "segment/session/cut_request.h"

namespace splatcut {

// grey: 128 and more become object. where: what the sentences of errors are about.
Mask checked_mask(Image<std::uint8_t> grey, const Camera& camera, const std::string& where);
Mask read_given_mask(const std::filesystem::path& path, const Camera& camera);

// A picture's name without its ending; "view.001" is a whole name.
std::string without_picture_ending(const std::filesystem::path& name);

// The cameras, by index, that a picture's name without ending can mean: first with its folders, then without.
std::vector<std::size_t> cameras_named(const std::vector<Camera>& cameras, const std::string& name);

struct MaskFolder {
  GivenView reference;
  std::vector<GivenView> others;  // in the order of the cameras; their masks may be reduced
  std::string warning;            // a sentence where the wanted camera is not the reference, or empty
};

struct MaskFolderOptions {
  std::filesystem::path folder;
  std::optional<std::string> reference;  // name of the wanted camera; otherwise the first with a mask
  std::optional<glm::ivec2> size_px;     // of every picture, in place of the cameras' own
};

// The .png files of the folder and of those in it; other files are not looked at. A camera NAME or NAME.jpg
// has the mask NAME.png, NAME.jpg.png or FOLDER/NAME.png.
MaskFolder load_mask_folder(const std::vector<Camera>& cameras, const MaskFolderOptions& options);

}  // namespace splatcut
