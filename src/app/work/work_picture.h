// A small picture of saved work, for lists of it. It lies beside the work file and is worth nothing without
// it.
//
// Errors: none are thrown; a picture that cannot be written or read, is damaged or is none of ours is no
// picture.
#pragma once

#include <filesystem>

#include "core/image.h"

namespace splatcut {

inline constexpr int kWorkPictureWidthPx = 96;

// Reduces a picture of the view to the width of a small one; one that is smaller stays as it is. It reads a
// few pixels for each of its own, so the size of the view costs nothing.
Image<Rgb8> work_picture(const Image<Rgba8>& view);

// NAME.png for NAME.splatcut.json.
std::filesystem::path picture_of_work(const std::filesystem::path& work);

// Writes the picture of a work file, or removes it if the picture is empty.
void write_work_picture(const std::filesystem::path& work, const Image<Rgb8>& picture);

// Empty: there is none.
Image<Rgba8> read_work_picture(const std::filesystem::path& work);

}  // namespace splatcut
