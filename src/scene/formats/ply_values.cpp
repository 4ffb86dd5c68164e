#include "scene/formats/ply_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/ranks.h"

namespace splatcut {

float load_as_float(const std::byte* at, PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return load_as_float<std::int8_t>(at);
    case PlyType::kUint8:
      return load_as_float<std::uint8_t>(at);
    case PlyType::kInt16:
      return load_as_float<std::int16_t>(at);
    case PlyType::kUint16:
      return load_as_float<std::uint16_t>(at);
    case PlyType::kInt32:
      return load_as_float<std::int32_t>(at);
    case PlyType::kUint32:
      return load_as_float<std::uint32_t>(at);
    case PlyType::kFloat32:
      return load_as_float<float>(at);
    case PlyType::kFloat64:
      return load_as_float<double>(at);
  }
  return 0;
}

glm::vec3 srgb_from_linear(const glm::vec3& linear) {
  constexpr float kStraight = 0.0031308f;
  glm::vec3 srgb;
  for (int c = 0; c < 3; ++c)
    srgb[c] = linear[c] <= kStraight ? 12.92f * linear[c] : 1.055f * std::pow(linear[c], 1 / 2.4f) - 0.055f;
  return srgb;
}

void fuse_filter(float filter, glm::vec3* scale, float* opacity) {
  const glm::vec3 fused = glm::sqrt(*scale * *scale + filter * filter);
  for (int axis = 0; axis < 3; ++axis)
    if (fused[axis] > 0) *opacity *= (*scale)[axis] / fused[axis];
  *scale = fused;
}

std::string rounded_positions(const PlyElement& vertex, const GaussianCloud& cloud) {
  const PlyProperty* x = vertex.find("x");
  if (!x || x->type != PlyType::kFloat64 || cloud.empty()) return {};
  const Box box = robust_bounds(cloud.position);
  const glm::vec3 far = glm::max(glm::abs(box.min), glm::abs(box.max));
  const float step = std::max({far.x, far.y, far.z}) * std::numeric_limits<float>::epsilon();
  std::vector<float> sizes(cloud.size());
  std::ranges::transform(cloud.scale, sizes.begin(), [](const glm::vec3& s) {
    return std::max({s.x, s.y, s.z});
  });
  const float size = median(sizes);
  constexpr float kVisible = 0.1f;  // of a Gaussian's size
  if (step <= kVisible * size) return {};
  return fmt::format(
      "Its positions, up to {:.3g} in double numbers, are rounded to {:.2g}, beside Gaussians of {:.2g}: "
      "move "
      "the scene near the origin in the program that wrote it",
      std::max({far.x, far.y, far.z}), step, size);
}

}  // namespace splatcut
