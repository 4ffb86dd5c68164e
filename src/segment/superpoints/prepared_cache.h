// What was prepared of a scene, kept in files: a scene opened again is ready at once.
//
// Key: a hash of the cloud's arrays, of the cameras and options that the preparation depends on, of the
// format's version and of the program's own bytes (another build may prepare differently). File: a header
// (magic, version, key, size, checksum) and the arrays as they lie in memory. A file that is truncated,
// damaged or of another machine is ignored, and so is a folder that cannot be read or written. Files appear
// whole or not at all. Where a folder, or what it holds of one scene, grows beyond its limit, the files that
// were not used for longest are removed; the last one of the scene stays. Cost: reading is bound by copying
// the arrays (some 110 bytes a Gaussian).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "segment/superpoints/prepared_scene.h"

namespace splatcut {

std::uint64_t prepared_key(const GaussianCloud& cloud, std::span<const Camera> observing,
                           const PrepareOptions& options);

// Its name begins with the scene.
std::filesystem::path prepared_file(const PreparedCache& cache, std::uint64_t key);

// The file's content; none where it is not what the key and the number of Gaussians ask for.
std::optional<PreparedScene> read_prepared(const std::filesystem::path& file, std::uint64_t key,
                                           std::size_t gaussians);

// Throws Error where it cannot be written.
void write_prepared(const std::filesystem::path& file, std::uint64_t key, const PreparedScene& prepared);

// Removes the files used longest ago, first of cache.scene, then of all scenes, until both limits are kept,
// and what interrupted writers left.
void trim_cache(const PreparedCache& cache);

}  // namespace splatcut
