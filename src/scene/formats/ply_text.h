// The rows of an ASCII .ply. Internal to src/scene/formats.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/job.h"
#include "scene/packing/ply_header.h"

namespace splatcut {

struct PlyTextRows {
  PlyElement element;         // the same properties, all of them float
  std::vector<float> values;  // row by row
};

// origin: taken off x, y and z. Throws Error for rows that are missing, lists, and words that are no numbers.
// Memory: at most four bytes for two of the file. Incomplete when cancelled.
PlyTextRows read_text_rows(const MappedFile& file, const PlyHeader& header, const PlyElement& element,
                           const glm::dvec3& origin, const Job& job);

}  // namespace splatcut
