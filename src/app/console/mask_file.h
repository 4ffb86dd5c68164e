// Masks as other tools write them: which pixels of a picture are the object.
//
// The first of these that fits, of a PNG, JPEG or WebP:
//   alpha that varies                            object where it is half or more
//   a palette of colours (SAM-Track)             object where the index is not 0
//   colours (any on black)                       object where it is not black
//   numbers from 0 (0 and 1, ids, 16 bit)        object where the number is not 0
//   grey, with something half bright or brighter object where it is half bright or brighter
#pragma once

#include <filesystem>
#include <string>

#include "core/image.h"
#include "core/picture_file.h"

namespace splatcut {

struct ReadMask {
  Mask mask;        // kMaskObject or 0; all 0 where the picture is black
  std::string how;  // it was understood, in words: "palette, index > 0"; empty where it is black
};

// where: what the sentences of errors are about. Throws Error for what read_picture() refuses, and for a
// photograph: a picture of colours without black.
ReadMask mask_of(const Picture& picture, const std::string& where);
ReadMask read_mask(const std::filesystem::path& path);

}  // namespace splatcut
