// Which pixels a click reaches without leaving what changes and without a jump in depth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/image.h"

namespace splatcut {

// In: per pixel from which index on it changes, below `indices`, or kNoLevel (leaf_view.h); camera z of the
// same size, 0 where nothing is; the clicked pixel. Out: per index, the share in [0, 1] of the pixels that
// change by then to which no way leads from the click's 3 x 3 pixels, in steps of one pixel along a row or
// column, through pixels that change by then, without ln of the depth changing by more than kJumpInOneStep. 0
// where nothing changes. Cost: linear.
std::vector<float> shares_out_of_reach(const Image<std::uint32_t>& level, std::size_t indices,
                                       const Image<float>& depth, const glm::ivec2& at);

}  // namespace splatcut
