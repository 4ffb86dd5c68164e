// Copies of a scene that a person would take for the same: through each format that can be written, with rows
// in another order, with every splat moved by a hundredth of its size. For asking whether an answer hangs on
// the last bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

struct SceneCopy {
  std::string name;
  Scene scene;
  std::vector<std::uint32_t> origin;  // per Gaussian of the copy: the one of `original` that it was
};

// Copy number 0, 1, ...: .ply with numbers rounded to 12 bits, .compressed.ply, .splat, .spz, rows shuffled,
// splats moved; from the sixth on shuffled and moved in turn, each by another draw. Throws Error where the
// temporary file cannot be written or read.
SceneCopy scene_copy(const Scene& original, int number, const Job& job = {});

}  // namespace splatcut
