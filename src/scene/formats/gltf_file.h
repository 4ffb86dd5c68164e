// A glTF file as its parts: text and buffers, from .glb, from files beside the text, from within it (base64).
// Internal to src/scene/formats.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "core/mapped_file.h"

namespace splatcut {

struct Gltf {
  nlohmann::json text;
  std::vector<std::span<const std::byte>> buffers;
  std::vector<std::unique_ptr<MappedFile>> beside;  // holds buffers of other files
  std::vector<std::vector<std::byte>> inside;       // and those of the text

  // Throws Error for what is truncated or no JSON, for buffers in other folders, and for an extension that is
  // required and not read, by its name.
  explicit Gltf(const MappedFile& file);
  Gltf(const Gltf&) = delete;
  Gltf& operator=(const Gltf&) = delete;
};

}  // namespace splatcut
