// Work that a crash left: what is said of it before it is restored.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/image.h"

namespace splatcut {

// Work that a crash left and that can be restored by opening its file.
struct LeftWork {
  std::filesystem::path file;
  std::filesystem::path scene;  // empty where the file cannot be read
  std::string says;  // time and scene: "18:40  garden/point_cloud.ply", "2026-03-01  garden/point_cloud.ply"
  Image<Rgba8> picture{};    // what the view showed, small; empty: nobody knows
  std::uint64_t serial = 0;  // number of the picture
  bool nothing = false;      // it holds no work, nor any that was undone
};

// Reads that from the file. Errors: none; what cannot be read stays empty, and is said when it is restored.
LeftWork left_work(const std::filesystem::path& work);

}  // namespace splatcut
