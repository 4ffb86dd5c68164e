#include "scene/formats/far_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/spoken_list.h"
#include "scene/formats/losses.h"

namespace splatcut {

namespace {

glm::vec3 farthest(const Box& box) {
  return glm::max(glm::abs(box.min), glm::abs(box.max));
}

// What 32 bits round numbers of that size by.
float float_step(const glm::vec3& size) {
  return std::max({size.x, size.y, size.z}) * std::numeric_limits<float>::epsilon();
}

}  // namespace

glm::dvec3 far_origin(const GaussianCloud& cloud) {
  if (cloud.empty()) return glm::dvec3(0);
  const Box box = robust_bounds(cloud.position);
  const float step = float_step(farthest(box));
  constexpr float kPrecise = 0.01f;  // of a Gaussian's size
  const bool helps = step > 2 * float_step(0.5f * box.extent());
  if (!helps || step <= kPrecise * middle_size(cloud, all_gaussians(cloud))) return glm::dvec3(0);
  return glm::round(0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max))) + 0.0;  // no -0
}

void take_off(const glm::dvec3& origin, Scene* scene) {
  scene->origin = origin;
  for (glm::vec3& position : scene->cloud.position) position = glm::vec3(glm::dvec3(position) - origin);
  add_sentence(rounded_positions(scene->cloud), &scene->oddity);
}

std::string spoken(const glm::dvec3& origin) {
  return fmt::format("{:.0f}, {:.0f}, {:.0f}", origin.x, origin.y, origin.z);
}

std::string rounded_positions(const GaussianCloud& cloud) {
  if (cloud.empty()) return {};
  const glm::vec3 far = farthest(robust_bounds(cloud.position));
  const float step = float_step(far), size = middle_size(cloud, all_gaussians(cloud));
  constexpr float kVisible = 0.1f;  // of a Gaussian's size
  if (step <= kVisible * size) return {};
  return fmt::format(
      "Its positions, up to {:.3g} from the origin, are rounded to {:.2g}, beside Gaussians of {:.2g}",
      std::max({far.x, far.y, far.z}), step, size);
}

}  // namespace splatcut
