// PNG out; in: picture_file.h. Files appear whole or not at all.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>

#include "core/image.h"

namespace splatcut {

// Throw Error when the file cannot be written.
void write_png(const std::filesystem::path& path, const Image<Rgb8>& image);
void write_png(const std::filesystem::path& path, const Image<Rgba8>& image);
void write_png(const std::filesystem::path& path, const Image<std::uint8_t>& grey);
void write_png(const std::filesystem::path& path, const Image<std::uint16_t>& grey16);

// The same bytes in memory.
std::string png_bytes(const Image<Rgb8>& image);
std::string png_bytes(const Image<Rgba8>& image);

// Clamps to [0, 1] and rounds.
Image<Rgb8> rgb8_from_linear(const Image<glm::vec3>& colour);
// Straight alpha of colours that are multiplied by their alpha (0 to 1); black where alpha is 0.
Image<Rgba8> rgba8_from_premultiplied(const Image<glm::vec3>& colour, const Image<float>& alpha);

}  // namespace splatcut
