// Writing of .ply. Internal to src/scene/formats.
#pragma once

#include <span>

#include "core/atomic_file.h"
#include "scene/formats/scene_file.h"
#include "scene/packing/ply_header.h"

namespace splatcut {

// Of the options: object ids, changed rows, up.

// Rows as they stand in the source file, which is a binary .ply, with object ids or with changed rows. Its
// header stays, but for the number of rows and for what it says of up.
void write_ply_subset(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options);

// Whether a row holds all that a changed one sets, as fractions.
bool can_change_rows(const PlyElement& vertex);

// Encoded from the cloud, in the layout of Kerbl et al.; positions in double where the scene has an origin.
void write_ply_rows(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                    const SaveOptions& options);

}  // namespace splatcut
