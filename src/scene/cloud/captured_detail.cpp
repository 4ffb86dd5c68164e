#include "scene/cloud/captured_detail.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace splatcut {

namespace {

// Half of the weight lies below it.
template <typename Value>
float weighted_median(const CapturedDetail& detail, const Value& value) {
  std::vector<std::pair<float, double>> items;
  items.reserve(detail.size());
  for (std::size_t i = 0; i < detail.size(); ++i)
    items.emplace_back(value(detail.position_world[i]), detail.weight[i]);
  std::ranges::sort(items);
  const double half = 0.5 * detail.total();
  double below = 0;
  for (const auto& [v, weight] : items)
    if ((below += weight) >= half) return v;
  return 0;
}

}  // namespace

double CapturedDetail::total() const {
  return std::accumulate(weight.begin(), weight.end(), 0.0);
}

void CapturedDetail::add(const glm::vec3& at_world, double w) {
  position_world.push_back(at_world);
  weight.push_back(w);
}

float middle_sigma(const glm::vec3& scale) {
  return std::max(std::min(scale.x, scale.y), std::min(std::max(scale.x, scale.y), scale.z));
}

CapturedDetail captured_detail(const GaussianCloud& cloud) {
  constexpr std::size_t kSample = 1 << 16;
  constexpr float kLeastOpacity = 0.1f;
  CapturedDetail detail;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSample);
  for (std::size_t g = 0; g < cloud.size(); g += step) {
    if (cloud.opacity[g] < kLeastOpacity) continue;
    detail.add(cloud.position[g], 1 / std::max(1e-30, static_cast<double>(middle_sigma(cloud.scale[g]))));
  }
  return detail;
}

Ball middle_half(const CapturedDetail& detail) {
  Ball ball;
  for (int axis = 0; axis < 3; ++axis)
    ball.centre_world[axis] = weighted_median(detail, [&](const glm::vec3& p) { return p[axis]; });
  ball.radius =
      weighted_median(detail, [&](const glm::vec3& p) { return glm::distance(p, ball.centre_world); });
  return ball;
}

}  // namespace splatcut
