// What a chain of parts changes in a click's view, index by index.
//
// In: a view, the index at which each leaf of a chain joins. Out: from which index on each pixel changes, and
// a box around all that has changed by an index, so that what is measured of a small part costs little. Cost:
// linear in the pixels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "segment/selection/leaf_view.h"

namespace splatcut {

struct LevelsInView {
  Image<std::uint32_t> of_pixel;  // index from which on it changes, or kNoLevel; see shown_from()
  std::vector<PixelRect> box;     // per index, around all that has changed by then
};

// joins: per leaf the index at which it joins, or kNoLevel. indices: how many there are.
LevelsInView levels_in_view(const LeafView& view, std::span<const std::uint32_t> joins, std::size_t indices);

// How central a pixel lies in what has changed by an index: its distance to the border over the largest one
// of the 4-connected region around it, in (0, 1]. The pixel itself counts as changed.
float centrality(const LevelsInView& levels, std::size_t index, const glm::ivec2& at);

}  // namespace splatcut
