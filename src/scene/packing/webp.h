// Pictures of exact bytes as lossless WebP. Internal to src/scene.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace splatcut {

// Throws Error naming file and picture for bytes that are no WebP, or whose pixels would take more memory
// than check_expansion() grants to a file of file_bytes.
Image<Rgba8> read_webp(const std::filesystem::path& file, std::string_view picture,
                       std::span<const std::byte> bytes, std::size_t file_bytes);

// Every byte as it is, those of transparent pixels too.
std::vector<std::byte> write_webp(const Image<Rgba8>& picture);

}  // namespace splatcut
