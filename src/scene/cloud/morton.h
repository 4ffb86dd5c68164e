// Z-order (Morton 1966) of points: neighbours in space become neighbours in memory.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/job.h"

namespace splatcut {

// A permutation that lists the points along a Z curve of 2^21 cells per axis over robust_bounds
// (points outside are clamped to it). Ties keep their index order. Positions must be finite, and fewer than
// 2^32. Cost: linear; threads by oneTBB, the same order on any number of them. When cancelled, the order is
// unspecified.
std::vector<std::uint32_t> morton_order(std::span<const glm::vec3> positions, const Job& job = {});

}  // namespace splatcut
