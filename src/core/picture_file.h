// Pictures of other programs, as masks come in: PNG of any kind, JPEG, WebP.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>

#include "core/image.h"

namespace splatcut {

struct Picture {
  Image<Rgba8> pixels;          // alpha 255 where the file has none
  Image<std::uint8_t> indices;  // of a PNG with a palette, else empty
  Image<std::uint16_t> grey16;  // of a grey PNG of 16 bits, as its numbers are, else empty
  bool lossy = false;           // JPEG: black is not quite black
};

// By what the file holds, not by its name. Throws Error for what is none of them, damaged, or larger than
// 32,768 pixels a side.
Picture read_picture(const std::filesystem::path& path);

// Any PNG as 8-bit RGB on black, or as 8-bit grey. Throw Error when it is missing, no PNG or damaged.
Image<Rgb8> read_png_rgb(const std::filesystem::path& path);
Image<std::uint8_t> read_png_grey(const std::filesystem::path& path);

// A PNG by its numbers: as 8-bit RGB where that is all that it holds, else as 16-bit RGB with alpha, the
// colours multiplied by it (8 bits: times 257). The other one is empty.
struct ExactPng {
  Image<Rgb8> rgb8;
  Image<Rgba16> rgba16;
};
ExactPng read_exact_png(const std::filesystem::path& path);

// Width and height of a PNG or JPEG without reading its pixels; none for other files.
std::optional<glm::ivec2> picture_size(const std::filesystem::path& path);

}  // namespace splatcut
