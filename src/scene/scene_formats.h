// One reader and one writer per file format; scene_file.cpp chooses among them. Internal to src/scene.
// Readers fill cloud (Morton order), file_rows and dropped, and throw Error for bad content. Writers get
// the Gaussians to write in file order (indices into scene.cloud) and return the sentence on what is lost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/atomic_file.h"
#include "scene/mapped_file.h"
#include "scene/scene_file.h"

namespace splatcut {

void read_ply(const MappedFile& file, Scene& scene, const Job& job);
void read_compressed_ply(const MappedFile& file, Scene& scene, const Job& job);
void read_splat(const MappedFile& file, Scene& scene, const Job& job);
void read_spz(const MappedFile& file, Scene& scene, const Job& job);

// True when the header names the element "chunk" and packed positions.
bool is_compressed_ply(const MappedFile& file);

// Rows as they stand in the source file, which is a .ply.
void write_ply_subset(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians);
std::string write_ply(AtomicFile& out, const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians);
std::string write_compressed_ply(AtomicFile& out, const GaussianCloud& cloud,
                                 std::span<const std::uint32_t> gaussians);
std::string write_splat(AtomicFile& out, const GaussianCloud& cloud,
                        std::span<const std::uint32_t> gaussians);
std::string write_spz(AtomicFile& out, const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians);

}  // namespace splatcut
