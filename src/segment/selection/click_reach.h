// Reach of a click: the pixels that a way leads to without leaving what changes and without a jump in depth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/image.h"

namespace splatcut {

// Shares of changing pixels that the click does not reach, one per index.
//
// level: per pixel the index from which on it changes, below `indices`, or kNoLevel (leaf_view.h). depth:
// camera z, scene units, of the same size; 0: nothing is there. at: the clicked pixel. A way starts in the
// click's 3 x 3 pixels, takes steps of one pixel along rows and columns, stays within pixels that change up
// to the index, and takes no step in which ln of the depth changes by more than kJumpInOneStep. Each share is
// in [0, 1], and 0 if nothing changes. Cost: linear.
std::vector<float> shares_out_of_reach(const Image<std::uint32_t>& level, std::size_t indices,
                                       const Image<float>& depth, const glm::ivec2& at);

}  // namespace splatcut
