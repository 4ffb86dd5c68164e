#include "segment/selection/click_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/pixel_steps.h"
#include "scene/raster/depth_jump.h"
#include "segment/selection/leaf_view.h"

namespace splatcut {

namespace {

// Distance from a pixel to the nearest other one for which `there` holds, or to what is outside of the
// picture.
float distance_to(const Mask& picture, const glm::ivec2& pixel, const auto& there) {
  int nearest2 = std::numeric_limits<int>::max();
  for (int ring = 1; ring * ring < nearest2; ++ring)
    for (int y = -ring; y <= ring; ++y)
      for (int x = -ring; x <= ring; x += std::abs(y) == ring ? 1 : 2 * ring) {
        const glm::ivec2 p = pixel + glm::ivec2(x, y);
        if (!picture.contains(p.x, p.y) || there(p)) nearest2 = std::min(nearest2, x * x + y * y);
      }
  return std::sqrt(static_cast<float>(nearest2));
}

}  // namespace

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

float distance_to_border(const Mask& mask, const glm::ivec2& at, bool object) {
  return distance_to(mask, at, [&](const glm::ivec2& p) { return (mask.at(p.x, p.y) != 0) != object; });
}

float distance_to_end(const Image<float>& depth, const Mask& displayed, const glm::ivec2& at, bool object) {
  constexpr float kLeastShare = 0.3f, kEdgePx = 1.5f;  // an edge is as wide as its two pixels
  const float to_border = distance_to_border(displayed, at, !object);
  if (!object) return to_border;
  const auto jump = [&](const glm::ivec2& p, const glm::ivec2& step) {
    return depth_jumps(depth, p - step, p + step, kJumpAroundClick);
  };
  const float to_edge = kEdgePx + distance_to(displayed, at, [&](const glm::ivec2& p) {
                          return jump(p, {1, 0}) || jump(p, {0, 1});
                        });
  return std::max(kLeastShare * to_border, std::min(to_border, to_edge));
}

}  // namespace splatcut
