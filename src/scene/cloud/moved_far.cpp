#include "scene/cloud/moved_far.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "core/parallel.h"

namespace splatcut {

std::string moved_far(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians, float sizes,
                      const std::function<glm::vec3(std::size_t i)>& read_back) {
  constexpr float kFar = 10;                   // sizes: one alone is said
  constexpr std::size_t kOfSoManySeen = 1000;  // fewer that move less are lost among the others
  std::size_t count = 0, far = 0;
  float farthest = 0;
  std::mutex adding;
  for_chunks(gaussians.size(), [&](std::size_t from, std::size_t to) {
    std::size_t count_here = 0, far_here = 0;
    float farthest_here = 0;
    for (std::size_t i = from; i < to; ++i) {
      const glm::vec3& size = cloud.scale[gaussians[i]];
      const float moves = glm::distance(cloud.position[gaussians[i]], read_back(i));
      const float largest = std::max({size.x, size.y, size.z});
      if (moves <= sizes * largest) continue;
      ++count_here;
      far_here += moves > kFar * largest;
      farthest_here = std::max(farthest_here, moves);
    }
    const std::lock_guard lock(adding);
    count += count_here;
    far += far_here;
    farthest = std::max(farthest, farthest_here);
  });
  if (far == 0 && count * kOfSoManySeen <= gaussians.size()) return {};
  const std::string times =
      sizes == kVisibly ? "half their size" : fmt::format("{:g} times their size", sizes);
  return fmt::format("{} Gaussian{} by more than {}, up to {:.2g} units", count,
                     count == 1 ? " moves" : "s move", times, farthest);
}

}  // namespace splatcut
