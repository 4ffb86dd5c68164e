// The order of Gaussians of which so many in a row share bounds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// Along the Morton curve, as the cloud lies: neighbours must share a chunk, or its bounds mean nothing. So
// those far out come last, in chunks of their own, and again those far out among them. In: which Gaussians,
// in any order. Out: the same. A chunk that strays alone do not fill has the outermost of the others, too.
std::vector<std::uint32_t> in_order_of_chunks(const GaussianCloud& cloud,
                                              std::span<const std::uint32_t> gaussians,
                                              std::size_t chunk_rows);

}  // namespace splatcut
