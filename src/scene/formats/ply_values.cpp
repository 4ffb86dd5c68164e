#include "scene/formats/ply_values.h"

#include <cmath>
#include <cstdint>

namespace splatcut {

double load_as_double(const std::byte* at, PlyType type) {
  if (type != PlyType::kFloat64) return load_as_float(at, type);
  double value = 0;
  std::memcpy(&value, at, sizeof value);
  return value;
}

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

}  // namespace splatcut
