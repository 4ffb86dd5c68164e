#include "segment/selection/click_reach.h"

#include <algorithm>

#include "core/pixel_steps.h"
#include "scene/raster/depth_jump.h"
#include "segment/selection/leaf_view.h"

namespace splatcut {

std::vector<float> shares_out_of_reach(const Image<std::uint32_t>& level, std::size_t indices,
                                       const Image<float>& depth, const glm::ivec2& at) {
  // Per index, pixels that are reached by then and whose neighbours nobody has looked at. A pixel is reached
  // by the largest index on the way to it, so in the order of indices each is looked at once.
  std::vector<std::vector<glm::ivec2>> open(indices);
  Image<std::uint8_t> seen(level.width(), level.height());
  const auto reach = [&](const glm::ivec2& p, std::size_t by) {
    const std::uint32_t own = level.at(p.x, p.y);
    std::uint8_t& been = seen.at(p.x, p.y);
    if (own == kNoLevel || been) return;
    been = 1;
    open[std::max<std::size_t>(own, by)].push_back(p);
  };
  for (int y = at.y - 1; y <= at.y + 1; ++y)
    for (int x = at.x - 1; x <= at.x + 1; ++x)
      if (level.contains(x, y)) reach({x, y}, 0);
  std::vector<std::size_t> reached(indices, 0), all(indices, 0);
  for (const std::uint32_t own : level.pixels())
    if (own != kNoLevel) ++all[own];
  for (std::size_t i = 0; i < indices; ++i)
    while (!open[i].empty()) {
      const glm::ivec2 p = open[i].back();
      open[i].pop_back();
      ++reached[i];
      for (const glm::ivec2& step : kFourSteps)
        if (level.contains(p.x + step.x, p.y + step.y) && depth_jump(depth, p, p + step) <= kJumpInOneStep)
          reach(p + step, i);
    }
  std::vector<float> shares;
  std::size_t reached_so_far = 0, all_so_far = 0;
  for (std::size_t i = 0; i < indices; ++i) {
    reached_so_far += reached[i];
    all_so_far += all[i];
    shares.push_back(
        all_so_far ? static_cast<float>(all_so_far - reached_so_far) / static_cast<float>(all_so_far) : 0.0f);
  }
  return shares;
}

}  // namespace splatcut
