#include "segment/orbit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

namespace splatcut {

ObjectExtent object_extent(const GaussianCloud& cloud, std::span<const std::uint8_t> labels) {
  std::vector<glm::vec3> positions;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (labels[g]) positions.push_back(cloud.position[g]);
  const Box box = robust_bounds(positions, 0.96);
  return {box.centre(), 0.5f * glm::length(box.extent())};
}

std::vector<Camera> orbit_cameras(const Camera& reference, const glm::vec3& up_world, const ObjectExtent& object,
                                  const OrbitOptions& options) {
  const glm::vec3 up = glm::normalize(up_world);
  const glm::vec3 back = reference.centre_world() - object.centre_world;
  const glm::vec3 flat = back - glm::dot(back, up) * up;
  const float elevation = std::atan2(glm::dot(back, up), glm::length(flat));
  const glm::vec3 azimuth0 = glm::length(flat) > 1e-6f ? glm::normalize(flat) : -reference.forward_world();
  const float distance = options.distance_sizes * 2 * object.radius;
  // The object fills 1 / distance_sizes of the picture's smaller side at the reference's field of view or wider.
  const float fov_y = std::clamp(2 * std::atan(0.5f * static_cast<float>(reference.height_px) / reference.fy_px),
                                 glm::radians(40.0f), glm::radians(70.0f));
  std::vector<Camera> cameras;
  for (int i = 0; i < options.views; ++i) {
    const int step = i / 2 + 1, sign = i % 2 == 0 ? 1 : -1;
    const float angle = glm::two_pi<float>() * static_cast<float>(sign * step) / static_cast<float>(options.views + 1);
    const float swing = (step % 2 == 0 ? 1.0f : -1.0f) * static_cast<float>(sign) * options.elevation_swing_rad;
    const float tilt = std::clamp(elevation + swing, glm::radians(-20.0f), glm::radians(75.0f));
    const glm::vec3 around = glm::angleAxis(angle, up) * azimuth0;
    const glm::vec3 direction = std::cos(tilt) * around + std::sin(tilt) * up;
    cameras.push_back(look_at(object.centre_world + distance * direction, object.centre_world, up, fov_y,
                              reference.width_px, reference.height_px));
  }
  return cameras;
}

}  // namespace splatcut
