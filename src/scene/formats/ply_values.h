// Values of a .ply as other tools write them. Internal to src/scene/formats.
#pragma once

#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>

#include "scene/packing/ply_header.h"

namespace splatcut {

template <class T>
float load_as_float(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<float>(value);
}
float load_as_float(const std::byte* at, PlyType type);
double load_as_double(const std::byte* at, PlyType type);

glm::vec3 srgb_from_linear(const glm::vec3& linear);

// filter_3D of Mip-Splatting (Yu et al. 2024), scene units: the Gaussian is blurred by what its training
// could resolve, and as much fainter as it is larger.
void fuse_filter(float filter, glm::vec3* scale, float* opacity);

}  // namespace splatcut
