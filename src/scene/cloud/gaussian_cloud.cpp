#include "scene/cloud/gaussian_cloud.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/ranks.h"

namespace splatcut {

namespace {

// The ninth decile of the largest axes, of 100,000 Gaussians at most, evenly over the rows.
float large_size(std::span<const glm::vec3> scales) {
  constexpr std::size_t kEnough = 100'000;
  std::vector<float> sizes;
  for (std::size_t g = 0; g < scales.size(); g += scales.size() / kEnough + 1)
    sizes.push_back(std::max({scales[g].x, scales[g].y, scales[g].z}));
  if (sizes.empty()) return 0;
  const auto decile = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 9 / 10);
  std::ranges::nth_element(sizes, decile);
  return *decile;
}

}  // namespace

void GaussianCloud::resize(std::size_t n, int degree) {
  assert(degree >= 0 && degree <= 3);
  sh_degree = degree;
  position.resize(n);
  scale.resize(n);
  rotation.resize(n, glm::quat(1, 0, 0, 0));
  opacity.resize(n);
  f_dc.resize(n);
  sh_rest.resize(n * sh_stride());
  file_row.resize(n);
}

GaussianCloud permuted(const GaussianCloud& cloud, std::span<const std::uint32_t> order) {
  GaussianCloud out;
  out.resize(order.size(), cloud.sh_degree);
  out.near_plane = cloud.near_plane;
  out.antialiased = cloud.antialiased;
  const std::size_t stride = cloud.sh_stride();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t g = order[i];
    assert(g < cloud.size());
    out.position[i] = cloud.position[g];
    out.scale[i] = cloud.scale[g];
    out.rotation[i] = cloud.rotation[g];
    out.opacity[i] = cloud.opacity[g];
    out.f_dc[i] = cloud.f_dc[g];
    out.file_row[i] = cloud.file_row[g];
    std::copy_n(cloud.sh_rest.data() + g * stride, stride, out.sh_rest.data() + i * stride);
  }
  return out;
}

Box robust_bounds(std::span<const glm::vec3> positions, double inside) {
  Box box;
  if (positions.empty()) return box;
  // A sample of every k-th point is enough for a percentile and keeps this linear and deterministic.
  constexpr std::size_t kSample = 1 << 16;
  const std::size_t step = std::max<std::size_t>(1, positions.size() / kSample);
  std::vector<float> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < positions.size(); i += step) values.push_back(positions[i][axis]);
    const double tail = 0.5 * (1.0 - inside) * static_cast<double>(values.size() - 1);
    const auto low = values.begin() + static_cast<std::ptrdiff_t>(tail);
    std::nth_element(values.begin(), low, values.end());
    box.min[axis] = *low;
    const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(tail);
    std::nth_element(values.begin(), high, values.end());
    box.max[axis] = *high;
  }
  return box;
}

float middle_size(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  std::vector<float> sizes;
  sizes.reserve(gaussians.size());
  for (const std::uint32_t g : gaussians)
    sizes.push_back(std::max({cloud.scale[g].x, cloud.scale[g].y, cloud.scale[g].z}));
  return median(std::move(sizes));
}

Box framed_bounds(const GaussianCloud& cloud) {
  Box box = robust_bounds(cloud.position, 0.9);
  if (glm::length(box.extent()) > 0 || cloud.scale.empty()) return box;
  constexpr float kSigmas = 3;
  float largest = 0;
  for (const glm::vec3& s : cloud.scale) largest = std::max({largest, s.x, s.y, s.z});
  box.min -= kSigmas * largest;
  box.max += kSigmas * largest;
  return box;
}

float natural_near_plane(std::span<const glm::vec3> positions) {
  const float diagonal = glm::length(robust_bounds(positions).extent());
  return diagonal > 0 ? kNaturalNearShare * diagonal : GaussianCloud{}.near_plane;
}

float near_plane_of(const GaussianCloud& cloud) {
  constexpr float kBlurredWithin = 7.5f;  // sizes of a large Gaussian
  float natural = 0;
  if (glm::length(robust_bounds(cloud.position).extent()) > 0) {
    natural = natural_near_plane(cloud.position);
  } else {
    const Box box = framed_bounds(cloud);
    natural = natural_near_plane(std::array{box.min, box.max});
  }
  const float large = large_size(cloud.scale);
  return large > 0 ? std::min(natural, kBlurredWithin * large) : natural;
}

}  // namespace splatcut
