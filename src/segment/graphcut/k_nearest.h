// The k nearest neighbours of every point among the others: k-d tree by nanoflann, queries on all cores,
// same answer on any number of threads. Cost: about n log n; points in Morton order are 4 times faster.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "core/job.h"

namespace splatcut {

inline constexpr std::uint32_t kNoNeighbour = std::numeric_limits<std::uint32_t>::max();

// k entries per point, nearest first, without the point itself; kNoNeighbour where there are fewer than k
// others. Finite points only.
std::vector<std::uint32_t> k_nearest(const std::vector<glm::vec3>& points, std::size_t k,
                                     const Job& job = {});

// The same for places that are not among the points: k entries per query.
std::vector<std::uint32_t> k_nearest_of(const std::vector<glm::vec3>& points,
                                        const std::vector<glm::vec3>& queries, std::size_t k,
                                        const Job& job = {});

}  // namespace splatcut
