// Masks that another tool made: read (mask_file.h), checked against their camera, found by its name.
//
// Throws Error for what cannot be used: unreadable, of another aspect than the camera's picture, black where
// one mask is all there is, of several cameras.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console/mask_file.h"
#include "core/image.h"
#include "scene/camera/camera.h"
#include "segment/session/cut_request.h"

namespace splatcut {

// In the size of the camera's picture. where: what the sentences of errors are about.
Mask checked_mask(ReadMask read, const Camera& camera, const std::string& where);

struct MaskFolder {
  GivenView reference;
  std::vector<GivenView> others;  // in the order of the cameras; their masks may be reduced
  std::string how;                // the masks were understood, a sentence
  std::vector<std::string>
      warnings;  // a sentence each: masks without a camera, another reference than wanted
};

struct MaskFolderOptions {
  std::filesystem::path folder;
  std::optional<std::string> reference;  // name of the wanted camera; otherwise the first with a mask
  std::optional<glm::ivec2> size_px;     // of every picture, in place of the cameras' own
};

// The .png, .jpg and .webp files of the folder and of those in it; hidden and other files are not looked at.
// A camera NAME or NAME.jpg has the mask NAME.png, NAME.jpg.png, FOLDER/NAME.png, or what else
// cameras_of_mask() finds. Where a mask is black, that camera sees nothing of the object.
MaskFolder load_mask_folder(const std::vector<Camera>& cameras, const MaskFolderOptions& options);

}  // namespace splatcut
