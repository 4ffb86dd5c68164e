// Scenes in and out: 3DGS .ply, compressed .ply (PlayCanvas), .splat, .spz (v1-v4).
// Loading orders the Gaussians along a Morton curve and keeps the file row of each.
// Errors: every unreadable or unsuitable file is an Error naming file, property, row or byte; sizes are
// checked against the file before memory is taken. A scene narrower than 1e-12 units or wider than 1e12 is
// refused; within, nothing depends on the unit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/gaussian_cloud.h"
#include "scene/job.h"

namespace splatcut {

enum class SceneFormat { kPly, kCompressedPly, kSplat, kSpz };
const char* name_of(SceneFormat format);

struct Scene {
  GaussianCloud cloud;         // Morton order
  std::filesystem::path path;  // where it came from; reopened to copy rows
  SceneFormat format = SceneFormat::kPly;
  std::size_t file_rows = 0;     // Gaussians in the file, dropped ones included
  std::size_t dropped = 0;       // rows left out: NaN, zero quaternion, beyond 1e15 units
  std::uint64_t file_bytes = 0;  // with modified_ns: to notice that the file changed since
  std::int64_t modified_ns = 0;
};

Scene load_scene(const std::filesystem::path& path, const Job& job = {});

// Format by extension: .ply, .compressed.ply, .splat, .spz. Throws Error for any other.
SceneFormat format_from_name(const std::filesystem::path& path);

struct SaveReport {
  std::size_t gaussians = 0;
  std::uint64_t bytes = 0;
  std::string loss;  // empty, or a sentence: "spherical harmonics of degree 2 are dropped"
};

// Writes the Gaussians with keep[g] != 0 (empty: all), in file order; compressed .ply in Morton order,
// because neighbours must share a chunk for its bounds to be narrow. From .ply to .ply the rows are copied
// byte for byte from scene.path (Error if that file changed since it was loaded).
SaveReport save_scene(const std::filesystem::path& path, const Scene& scene,
                      std::span<const std::uint8_t> keep, SceneFormat format);

}  // namespace splatcut
