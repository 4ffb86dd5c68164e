#include "scene/cloud/chunk_order.h"

#include <algorithm>
#include <numeric>

#include "scene/cloud/morton.h"

namespace splatcut {

namespace {

// How far out each lies: 1 on a cube around the bounds that leave outliers out.
std::vector<float> distances_out(std::span<const glm::vec3> positions) {
  const Box box = robust_bounds(positions);
  const glm::vec3 middle = 0.5f * (box.min + box.max), half = 0.5f * box.extent();
  const float reach = std::max({half.x, half.y, half.z});
  std::vector<float> distances(positions.size());
  std::ranges::transform(positions, distances.begin(), [&](const glm::vec3& p) {
    const glm::vec3 away = glm::abs(p - middle);
    return reach > 0 ? std::max({away.x, away.y, away.z}) / reach : 0;
  });
  return distances;
}

// The outermost of a list that is in Morton order, taken off its end once they stand there; as many as leave
// whole chunks. None where nothing lies far out, or where all fit one chunk.
std::vector<std::uint32_t> take_strays(const GaussianCloud& cloud, std::size_t chunk_rows,
                                       std::vector<std::uint32_t>* list) {
  constexpr float kFar = 2;  // of distances_out(): a chunk is coarser by as much
  std::vector<glm::vec3> positions;
  for (const std::uint32_t g : *list) positions.push_back(cloud.position[g]);
  const std::vector<float> out = distances_out(positions);
  const auto strays = static_cast<std::size_t>(std::ranges::count_if(out, [](float d) { return d > kFar; }));
  const std::size_t stay = (list->size() - strays) / chunk_rows * chunk_rows;
  if (strays == 0 || stay == 0) return {};
  std::vector<std::uint32_t> by_distance(list->size());
  std::iota(by_distance.begin(), by_distance.end(), 0u);
  std::ranges::stable_sort(by_distance, {}, [&](std::uint32_t i) { return out[i]; });
  std::ranges::sort(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(stay));
  std::vector<std::uint32_t> sorted;
  for (const std::uint32_t i : by_distance) sorted.push_back((*list)[i]);
  std::vector<std::uint32_t> taken(sorted.begin() + static_cast<std::ptrdiff_t>(stay), sorted.end());
  sorted.resize(stay);
  *list = std::move(sorted);
  return taken;
}

}  // namespace

std::vector<std::uint32_t> in_order_of_chunks(const GaussianCloud& cloud,
                                              std::span<const std::uint32_t> gaussians,
                                              std::size_t chunk_rows) {
  std::vector<std::uint32_t> order, list(gaussians.begin(), gaussians.end());
  std::ranges::sort(list);
  while (!list.empty()) {
    std::vector<std::uint32_t> strays = take_strays(cloud, chunk_rows, &list);
    order.insert(order.end(), list.begin(), list.end());
    std::vector<glm::vec3> positions;
    for (const std::uint32_t g : strays) positions.push_back(cloud.position[g]);
    list.clear();
    for (const std::uint32_t i : morton_order(positions)) list.push_back(strays[i]);
  }
  return order;
}

}  // namespace splatcut
