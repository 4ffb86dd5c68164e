// Reach of a click: the pixels that a way leads to without leaving what changes and without a jump in depth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/image.h"

namespace splatcut {

// Per pixel a bit for each of kFourSteps (core/pixel_steps.h): set where the step stays in the picture and
// the depth jumps by no more than kJumpInOneStep. depth: camera z, scene units; 0: nothing is there.
Image<std::uint8_t> steps_without_jump(const Image<float>& depth);

// Shares of changing pixels that the click does not reach, one per index.
//
// level: per pixel the index from which on it changes, below `indices`, or kNoLevel (leaf_view.h). steps:
// those of the same picture that a way may take. at: the clicked pixel. A way starts in the click's 3 x 3
// pixels and stays within pixels that change up to the index. Each share is in [0, 1], and 0 if nothing
// changes. Cost: linear.
std::vector<float> shares_out_of_reach(const Image<std::uint32_t>& level, std::size_t indices,
                                       const Image<std::uint8_t>& steps, const glm::ivec2& at);

// Distance in pixels from one to the border of the region of object, or of rest, around it; the picture's
// frame is a border, too. At least 1. Cost: the square of the distance.
float distance_to_border(const Mask& mask, const glm::ivec2& at, bool object);

// Distance from a clicked pixel to where the wrong region around it may end. What is wrongly object ends at
// the displayed border. What is missing (object: the click is on the object) need not touch what is shown: it
// may end at a depth edge before that. Depth is rough on captures, so an edge shortens the distance to a
// share of it at most.
float distance_to_end(const Image<float>& depth, const Mask& displayed, const glm::ivec2& at, bool object);

}  // namespace splatcut
