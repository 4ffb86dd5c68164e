// The memory that a scene will take, foretold before any of it is taken: a system out of memory ends programs
// without a word.
//
// In: how many Gaussians, which degree of spherical harmonics. Out: bytes that loading it and drawing all of
// it take at their peak, without the mapped file, which the system can drop. Measured from 2 to 12 M
// Gaussians: 86 to 94 bytes each at degree 0 (docs/benchmarks.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace splatcut {

std::uint64_t memory_of_scene(std::uint64_t gaussians, int sh_degree);

// Bytes that programs can still take without swapping; none where the system does not say.
std::optional<std::uint64_t> available_memory();

// Throws Error where the scene needs more than is available.
void check_memory(const std::filesystem::path& file, std::uint64_t gaussians, int sh_degree,
                  std::optional<std::uint64_t> available = available_memory());

}  // namespace splatcut
