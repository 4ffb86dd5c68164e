// Jumps of the depth in a picture (camera z, 0 where nothing is): another surface begins there.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/image.h"

namespace splatcut {

// True if the depths of two pixels differ by more than this factor, above 1, or one of them alone shows
// anything. Outside of the picture its frame counts.
inline bool depth_jumps(const Image<float>& depth, const glm::ivec2& a, const glm::ivec2& b, float factor) {
  const auto at = [&](const glm::ivec2& p) {
    return depth.at(std::clamp(p.x, 0, depth.width() - 1), std::clamp(p.y, 0, depth.height() - 1));
  };
  const auto [nearer, farther] = std::minmax({at(a), at(b)});
  return farther > factor * nearer;
}

// The factors. They differ by how far apart the two pixels are and by what a false jump costs. The first
// and the last feed terms of the fitted model: other values want another fit.
// Across three pixel steps in small pictures, for a share of the border summed over views: errors average
// out.
inline constexpr float kJumpAtBorderOfPart = 1.0513f;
// Across two pixel steps in the clicked view: one false edge shrinks the click's disc.
inline constexpr float kJumpAroundClick = 1.1618f;
// In one pixel step: one false edge bars the way to all behind it, and captures' depth is rough.
inline constexpr float kJumpInOneStep = 1.2214f;

// Of two depths: their difference over the lesser, at most 1.
inline float relative_depth_jump(float z0, float z1) {
  return std::min(1.0f, std::abs(z0 - z1) / std::max(1e-30f, std::min(z0, z1)));
}
// The largest of these in one pixel step, from all pixels under a brush's path: a false edge is gone around.
// A surface that is seen at 87 degrees, in 1,000 pixels to 60 degrees, has 0.022.
inline constexpr float kJumpUnderBrush = 0.03f;

}  // namespace splatcut
