// Pixels of the bound framebuffer's first attachment, in the order of its rows.
#pragma once

#include <glm/glm.hpp>

#include "core/image.h"

namespace splatcut {

Image<glm::vec4> read_back_rgba32f(int width, int height);

// bottom_first: the framebuffer's row 0 is the picture's bottom, as in windows; the result has the top first.
Image<Rgb8> read_back_rgb8(int width, int height, bool bottom_first);

}  // namespace splatcut
