#include "segment/selection/click_reach.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/pixel_steps.h"
#include "scene/raster/depth_jump.h"
#include "segment/selection/leaf_view.h"

namespace splatcut {

Image<std::uint8_t> steps_without_jump(const Image<float>& depth) {
  Image<std::uint8_t> steps(depth.width(), depth.height());
  const auto add = [&](const glm::ivec2& from, std::size_t there, std::size_t back) {
    const glm::ivec2 to = from + kFourSteps[there];
    const bool may = depth.contains(to.x, to.y) && !depth_jumps(depth, from, to, kJumpInOneStep);
    if (!may) return;
    steps.at(from.x, from.y) |= static_cast<std::uint8_t>(1u << there);
    steps.at(to.x, to.y) |= static_cast<std::uint8_t>(1u << back);
  };
  static_assert(kFourSteps[0] == -kFourSteps[1] && kFourSteps[2] == -kFourSteps[3]);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      add({x, y}, 0, 1);
      add({x, y}, 2, 3);
    }
  return steps;
}

std::vector<float> shares_out_of_reach(const Image<std::uint32_t>& level, std::size_t indices,
                                       const Image<std::uint8_t>& steps, const glm::ivec2& at) {
  const int width = level.width();
  std::array<int, kFourSteps.size()> offset;
  std::ranges::transform(kFourSteps, offset.begin(),
                         [&](const glm::ivec2& step) { return step.y * width + step.x; });
  // Pixels that are not reached yet, by their index. A pixel is reached by the largest index on the way to
  // it, so in the order of indices each is looked at once.
  std::vector<std::uint32_t> left(level.pixels().begin(), level.pixels().end());
  std::vector<std::vector<int>> open(indices);  // reached by the index, neighbours not looked at
  const auto reach = [&](int pixel, std::size_t by) {
    const std::size_t own = std::exchange(left[static_cast<std::size_t>(pixel)], kNoLevel);
    if (own != kNoLevel) open[std::max(own, by)].push_back(pixel);
  };
  for (int y = at.y - 1; y <= at.y + 1; ++y)
    for (int x = at.x - 1; x <= at.x + 1; ++x)
      if (level.contains(x, y)) reach(y * width + x, 0);
  std::vector<std::size_t> reached(indices, 0), all(indices, 0);
  for (const std::uint32_t own : level.pixels())
    if (own != kNoLevel) ++all[own];
  for (std::size_t i = 0; i < indices; ++i)
    while (!open[i].empty()) {
      const int pixel = open[i].back();
      open[i].pop_back();
      ++reached[i];
      const std::uint8_t may = steps.pixels()[static_cast<std::size_t>(pixel)];
      for (std::size_t step = 0; step < offset.size(); ++step)
        if (may >> step & 1) reach(pixel + offset[step], i);
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
