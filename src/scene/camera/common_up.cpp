#include "scene/camera/common_up.h"

#include <cmath>

#include "core/symmetric_eigen.h"

namespace splatcut {

namespace {

constexpr int kRight = 0, kDown = 1, kForward = 2;

// Of one axis of all cameras.
struct AxisPlane {
  glm::vec3 normal_world{0};
  double error_rad = 0;  // of the normal
  bool known = false;
};

glm::vec3 mean_axis(std::span<const Camera> cameras, int axis) {
  glm::vec3 sum(0);
  for (const Camera& c : cameras) sum += glm::transpose(c.camera_from_world_rotation)[axis];
  return sum / static_cast<float>(cameras.size());
}

AxisPlane plane_of(std::span<const Camera> cameras, int axis) {
  constexpr double kLeastOut = 0.003;  // hands roll a camera by 3 degrees: a few views may agree by chance
  constexpr double kMostError = 0.06;  // radians
  constexpr double kFlat = 3;          // e2 / e1 of a plane, not a cone
  constexpr double kFan = 0.06;        // e2 / e3: less is how hands look up and down
  // Cameras side by side that look down: their down axes avoid the view axis, too.
  constexpr double kArc = 0.3;         // e2 / e3 of less than that
  constexpr float kAlongView = 0.75f;  // of the mean view axis along the normal
  glm::dmat3 sum(0);
  for (const Camera& c : cameras) {
    const glm::dvec3 a(glm::transpose(c.camera_from_world_rotation)[axis]);
    sum += glm::outerProduct(a, a);
  }
  const auto n = static_cast<double>(cameras.size());
  const SymmetricEigen eigen = symmetric_eigen(sum / n);
  int least = 0, most = 0;
  for (int i = 1; i < 3; ++i) {
    if (eigen.values[i] < eigen.values[least]) least = i;
    if (eigen.values[i] >= eigen.values[most]) most = i;
  }
  const double e1 = eigen.values[least], e2 = eigen.values[3 - least - most], e3 = eigen.values[most];
  const glm::vec3 normal(eigen.axes[least]);
  const bool along_view =
      e2 < kArc * e3 && std::abs(glm::dot(mean_axis(cameras, kForward), normal)) > kAlongView;
  const double error_rad = std::sqrt(std::max(e1, kLeastOut) / (n * e2));
  return {normal, error_rad, error_rad < kMostError && e2 > kFlat * e1 && e2 > kFan * e3 && !along_view};
}

}  // namespace

glm::vec3 common_up(std::span<const Camera> cameras) {
  constexpr float kClearly = 0.6f;  // of the other's error or, inverted, length: else pictures are upright
  constexpr float kLeans = 0.1f;    // of a mean axis along up: else its sign is chance
  if (cameras.empty()) return {0, -1, 0};
  const glm::vec3 right = mean_axis(cameras, kRight), down = mean_axis(cameras, kDown);
  const AxisPlane upright = plane_of(cameras, kRight), on_side = plane_of(cameras, kDown);
  const bool lies = on_side.known &&
                    (!upright.known || on_side.error_rad < static_cast<double>(kClearly) * upright.error_rad);
  if (lies || upright.known) {
    const glm::vec3 normal = lies ? on_side.normal_world : upright.normal_world;
    // Upright pictures say which side is up; those on their side, and straight down, are taken from above.
    const float says = lies ? 0 : -glm::dot(down, normal);
    const float looks_down = -glm::dot(mean_axis(cameras, kForward), normal);
    const float sign = std::abs(says) > kLeans         ? says
                       : std::abs(looks_down) > kLeans ? looks_down
                                                       : glm::dot(right, normal);
    return sign < 0 ? -normal : normal;
  }
  const glm::vec3 up = glm::length(down) > kClearly * glm::length(right) ? -down : right;
  return glm::length(up) > 1e-6f ? glm::normalize(up) : glm::vec3(0, -1, 0);
}

}  // namespace splatcut
