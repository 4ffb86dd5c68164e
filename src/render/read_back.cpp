#include "render/read_back.h"

#include <glad/gl.h>

#include <algorithm>

namespace splatcut {

Image<glm::vec4> read_back_rgba32f(int width, int height) {
  Image<glm::vec4> picture(width, height);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, picture.data());
  return picture;
}

Image<Rgb8> read_back_rgb8(int width, int height, bool bottom_first) {
  Image<Rgb8> picture(width, height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, picture.data());
  if (bottom_first)
    for (int y = 0; y < height / 2; ++y)
      std::ranges::swap_ranges(picture.row(y), picture.row(height - 1 - y));
  return picture;
}

}  // namespace splatcut
