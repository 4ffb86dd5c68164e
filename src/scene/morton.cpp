#include "scene/morton.h"

#include <algorithm>

#include "scene/gaussian_cloud.h"
#include "scene/radix_sort.h"

namespace splatcut {

namespace {

constexpr int kBitsPerAxis = 21;

// Spreads the low 21 bits of v so that two zero bits follow each.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const glm::vec3> positions) {
  const Box box = robust_bounds(positions);
  constexpr float kCells = 1 << kBitsPerAxis;
  const glm::vec3 cells_per_unit = kCells / glm::max(box.extent(), glm::vec3(1e-20f));
  std::vector<KeyValue<std::uint64_t>> items(positions.size()), scratch;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3 cell = glm::clamp((positions[i] - box.min) * cells_per_unit, 0.0f, kCells - 1);
    items[i] = {spread_bits(static_cast<std::uint64_t>(cell.x)) | spread_bits(static_cast<std::uint64_t>(cell.y)) << 1 |
                    spread_bits(static_cast<std::uint64_t>(cell.z)) << 2,
                static_cast<std::uint32_t>(i)};
  }
  radix_sort(items, scratch, 3 * kBitsPerAxis);
  std::vector<std::uint32_t> order(items.size());
  std::transform(items.begin(), items.end(), order.begin(), [](const auto& item) { return item.value; });
  return order;
}

}  // namespace splatcut
