#include "segment/superpoints/usual_picture.h"

#include <algorithm>
#include <cmath>

#include "core/ranks.h"

namespace splatcut {

namespace {

constexpr float kCloseUp = 1.5f;         // times the picture's own breadth
constexpr float kWidest = 3;             // times its own: the sides of wider pictures are stretched
constexpr float kLeastBreadth = 1e-15f;  // of a point in the camera itself

float breadth_at(const Camera& camera, const glm::vec3& point_world) {
  const float area_px = static_cast<float>(camera.width_px) * static_cast<float>(camera.height_px);
  return std::sqrt(area_px) * glm::distance(camera.centre_world(), point_world) / camera.fx_px;
}

std::optional<UsualPicture> of_photographs(const Camera& own, std::span<const Camera> photographs,
                                           const glm::vec3& point_world) {
  std::vector<float> distances, breadths;
  for (const Camera& camera : photographs) {
    if (!camera.shows(point_world)) continue;
    distances.push_back(glm::distance(camera.centre_world(), point_world));
    breadths.push_back(breadth_at(camera, point_world));
  }
  if (std::ssize(distances) < kEnoughPhotographs) return std::nullopt;
  const float breadth = quantile(&breadths, 0.5f);
  return UsualPicture{quantile(&distances, 0.5f), breadth,
                      breadth / std::max(breadth_at(own, point_world), kLeastBreadth)};
}

std::optional<UsualPicture> of_subject(const Camera& camera, const Ball& subject,
                                       const glm::vec3& point_world) {
  constexpr float kPictureRadii = 2.3f, kSubjectRadii = 3, kMost = 3.3f;
  if (glm::distance(point_world, subject.centre_world) > kSubjectRadii * subject.radius) return std::nullopt;
  const float own = std::max(breadth_at(camera, point_world), kLeastBreadth);
  const float factor = kPictureRadii * subject.radius / own;
  if (!(factor > kCloseUp && factor < kMost)) return std::nullopt;
  return UsualPicture{factor * glm::distance(camera.centre_world(), point_world), factor * own, factor};
}

}  // namespace

Capture capture_of(const GaussianCloud& cloud, std::span<const Camera> photographs) {
  Capture capture{.photographs = {photographs.begin(), photographs.end()}, .subject = {}};
  if (photographs.empty()) capture.subject = middle_half(captured_detail(cloud));
  return capture;
}

std::optional<UsualPicture> usual_picture(const Camera& camera, const Capture& capture,
                                          const glm::vec3& point_world) {
  return capture.photographs.empty() ? of_subject(camera, capture.subject, point_world)
                                     : of_photographs(camera, capture.photographs, point_world);
}

bool is_close_up(const std::optional<UsualPicture>& usual) {
  return usual && usual->times_own > kCloseUp;
}

Margins margins_of_close_up(const Camera& camera, const std::optional<UsualPicture>& usual) {
  if (!is_close_up(usual)) return {};
  const float margin = (std::min(usual->times_own, kWidest) - 1) / 2;
  const int beside_px = static_cast<int>(margin * static_cast<float>(camera.width_px));
  const int above_px = static_cast<int>(margin * static_cast<float>(camera.height_px));
  return {beside_px, above_px, beside_px, above_px};
}

}  // namespace splatcut
