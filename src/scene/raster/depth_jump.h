// Jumps of the depth in a picture (camera z, 0 where nothing is): another surface begins there.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/image.h"

namespace splatcut {

// |ln| of the ratio of two pixels' depths; outside of the picture its frame counts. Infinite where one of
// them alone shows anything.
float depth_jump(const Image<float>& depth, const glm::ivec2& a, const glm::ivec2& b);

// More than one of these is a jump. They differ by how far apart the two pixels are and by what a false jump
// costs. The first and the last feed terms of the fitted model: other values want another fit.
// Across three pixel steps in small pictures, for a share of the border summed over views: errors average
// out.
inline constexpr float kJumpAtBorderOfPart = 0.05f;
// Across two pixel steps in the clicked view: one false edge shrinks the click's disc.
inline constexpr float kJumpAroundClick = 0.15f;
// In one pixel step: one false edge bars the way to all behind it, and captures' depth is rough.
inline constexpr float kJumpInOneStep = 0.2f;
// In one pixel step, from all pixels under a brush's path: a false edge is gone around. A surface that is
// seen at 87 degrees, in 1,000 pixels to 60 degrees, has 0.022.
inline constexpr float kJumpUnderBrush = 0.03f;

// Of two depths: their difference over the lesser, at most 1.
inline float relative_depth_jump(float z0, float z1) {
  return std::min(1.0f, std::abs(z0 - z1) / std::max(1e-30f, std::min(z0, z1)));
}

}  // namespace splatcut
