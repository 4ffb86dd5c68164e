// Writing of .ply. Internal to src/scene/formats.
#pragma once

#include <span>

#include "core/atomic_file.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// Rows as they stand in the source file, which is a binary .ply.
void write_ply_subset(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians);

// Encoded from the cloud, in the layout of Kerbl et al.; positions in double where the scene has an origin.
void write_ply_rows(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians);

}  // namespace splatcut
