#include "segment/superpoints/orbit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/ranks.h"

namespace splatcut {

ObjectExtent object_extent(const GaussianCloud& cloud, std::span<const std::uint8_t> labels) {
  std::vector<glm::vec3> positions;
  float largest = 0;
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    if (!labels[g]) continue;
    positions.push_back(cloud.position[g]);
    largest = std::max({largest, cloud.scale[g].x, cloud.scale[g].y, cloud.scale[g].z});
  }
  const Box box = robust_bounds(positions, 0.96);
  const float radius = 0.5f * glm::length(box.extent());
  constexpr float kReach = 3;  // standard deviations
  return {box.centre(), radius > 0 ? radius : kReach * largest};
}

namespace {

// Of the object's circle: an axis, where it starts, how high.
struct Circle {
  glm::vec3 up{0}, azimuth{0};
  float elevation_rad = 0;
};

// Where the camera stands from the centre, level; straight above or below it, where the picture's lower side
// points.
Circle circle_of(const Camera& camera, const glm::vec3& up, const glm::vec3& centre) {
  const auto level = [&](const glm::vec3& v) { return v - glm::dot(v, up) * up; };
  const glm::vec3 back = camera.centre_world() - centre, flat = level(back);
  glm::vec3 azimuth = flat;
  constexpr float kNothing = 1e-6f;  // of the vector that is made level
  if (!(glm::length(flat) > kNothing * glm::length(back))) {
    azimuth = level(-camera.forward_world());
    if (!(glm::length(azimuth) > kNothing)) azimuth = level(camera.down_world());
  }
  return {up, glm::normalize(azimuth), std::atan2(glm::dot(back, up), glm::length(flat))};
}

// The object fills 1 / distance_sizes of the picture's smaller side at the reference's field of view or
// wider.
float wide_enough(const Camera& reference) {
  return std::clamp(2 * std::atan(0.5f * static_cast<float>(reference.height_px) / reference.fy_px),
                    glm::radians(40.0f), glm::radians(70.0f));
}

std::vector<Camera> on_circle(const Camera& reference, const Circle& circle, const ObjectExtent& object,
                              const OrbitOptions& options) {
  const float distance = options.distance_sizes * 2 * object.radius;
  std::vector<Camera> cameras;
  for (int i = 0; i < options.views; ++i) {
    const int step = i / 2 + 1, sign = i % 2 == 0 ? 1 : -1;
    const float angle =
        glm::two_pi<float>() * static_cast<float>(sign * step) / static_cast<float>(options.views + 1);
    const float swing =
        (step % 2 == 0 ? 1.0f : -1.0f) * static_cast<float>(sign) * options.elevation_swing_rad;
    const float tilt = std::clamp(circle.elevation_rad + swing, glm::radians(-20.0f), glm::radians(75.0f));
    const glm::vec3 around = glm::angleAxis(angle, circle.up) * circle.azimuth;
    const glm::vec3 direction = std::cos(tilt) * around + std::sin(tilt) * circle.up;
    cameras.push_back(look_at(object.centre_world + distance * direction, object.centre_world, circle.up,
                              wide_enough(reference), reference.width_px, reference.height_px));
  }
  return cameras;
}

// Directions from the object, within the angles from which it was photographed, on two turns outward from the
// reference.
std::vector<Camera> on_spiral(const Camera& reference, const glm::vec3& up, const ObjectExtent& object,
                              std::span<const Camera> given, const OrbitOptions& options) {
  const glm::vec3 back = glm::normalize(reference.centre_world() - object.centre_world);
  const glm::vec3 right = glm::normalize(glm::cross(up, back)), above = glm::cross(back, right);
  std::vector<float> sideways, upwards;
  for (const Camera& camera : given) {
    const glm::vec3 from = glm::normalize(camera.centre_world() - object.centre_world);
    sideways.push_back(std::abs(glm::dot(from, right)));
    upwards.push_back(std::abs(glm::dot(from, above)));
  }
  constexpr double kMost = 0.9;  // of the photographs stand nearer than the spiral's outer end
  const float reach_x = quantile(&sideways, kMost), reach_y = quantile(&upwards, kMost);
  const float distance = options.distance_sizes * 2 * object.radius;
  std::vector<Camera> cameras;
  for (int i = 1; i <= options.views; ++i) {
    const float along = static_cast<float>(i) / static_cast<float>(options.views),
                angle = 2 * glm::two_pi<float>() * along;
    const glm::vec3 direction = glm::normalize(
        back + along * (reach_x * std::cos(angle) * right + reach_y * std::sin(angle) * above));
    cameras.push_back(look_at(object.centre_world + distance * direction, object.centre_world, up,
                              wide_enough(reference), reference.width_px, reference.height_px));
  }
  return cameras;
}

}  // namespace

bool front_facing(std::span<const Camera> given) {
  constexpr float kOneSide =
      0.854f;  // mean direction of a uniform cone of half angle 45 degrees: (1 + cos 45) / 2
  glm::vec3 sum(0);
  for (const Camera& camera : given) sum += camera.forward_world();
  return !given.empty() && glm::length(sum) > kOneSide * static_cast<float>(given.size());
}

Camera with_room(const Camera& camera, const ObjectExtent& object) {
  constexpr float kShare = 0.5f;  // of what lies between: the radius holds nearly all of the object, not all
  Camera roomy = camera;
  const float room = glm::distance(camera.centre_world(), object.centre_world) - object.radius;
  if (room > 0) roomy.most_near_plane = std::min(roomy.most_near_plane, kShare * room);
  return roomy;
}

namespace {

std::vector<Camera> without_room(const Camera& reference, const glm::vec3& up_world,
                                 const ObjectExtent& object, std::span<const Camera> given,
                                 const OrbitOptions& options) {
  const glm::vec3 up = glm::normalize(up_world);
  if (given.empty()) return orbit_cameras(reference, up, object, options);
  if (front_facing(given)) return on_spiral(reference, up, object, given, options);
  Circle circle = circle_of(reference, up, object.centre_world);
  std::vector<float> elevation;
  for (const Camera& camera : given)
    elevation.push_back(circle_of(camera, up, object.centre_world).elevation_rad);
  circle.elevation_rad = quantile(&elevation, 0.5);
  return on_circle(reference, circle, object, options);
}

}  // namespace

std::vector<Camera> cameras_around(const Camera& reference, const glm::vec3& up_world,
                                   const ObjectExtent& object, std::span<const Camera> given,
                                   const OrbitOptions& options) {
  std::vector<Camera> cameras = without_room(reference, up_world, object, given, options);
  for (Camera& camera : cameras) camera = with_room(camera, object);
  return cameras;
}

Camera approached(const Camera& camera, const glm::vec3& point_world, float share) {
  Camera nearer = camera;
  const glm::vec3 centre = point_world + share * (camera.centre_world() - point_world);
  nearer.camera_from_world_translation = -(camera.camera_from_world_rotation * centre);
  return nearer;
}

std::vector<Camera> orbit_cameras(const Camera& reference, const glm::vec3& up_world,
                                  const ObjectExtent& object, const OrbitOptions& options) {
  return on_circle(reference, circle_of(reference, glm::normalize(up_world), object.centre_world), object,
                   options);
}

}  // namespace splatcut
