// Files of 3D capture that are no scenes of Gaussians we read, and what to do instead. Internal to src/scene.
#pragma once

#include "core/mapped_file.h"

namespace splatcut {

// Throws Error for a file that is known by its first bytes or its name.
void refuse_foreign(const MappedFile& file);

}  // namespace splatcut
