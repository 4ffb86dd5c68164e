#include "scene/raster/depth_jump.h"

#include <limits>

namespace splatcut {

float depth_jump(const Image<float>& depth, const glm::ivec2& a, const glm::ivec2& b) {
  const auto at = [&](const glm::ivec2& p) {
    return depth.at(std::clamp(p.x, 0, depth.width() - 1), std::clamp(p.y, 0, depth.height() - 1));
  };
  const float one = at(a), other = at(b);
  if (one > 0 && other > 0) return std::abs(std::log(one / other));
  return (one > 0) == (other > 0) ? 0 : std::numeric_limits<float>::infinity();
}

}  // namespace splatcut
