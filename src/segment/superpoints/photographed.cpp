#include "segment/superpoints/photographed.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/ranks.h"

namespace splatcut {

namespace {

constexpr float kCloseUp = 1.5f;  // times the picture's own breadth
constexpr float kWidest = 3;      // times its own: the sides of wider pictures are stretched

float breadth_at(const Camera& camera, const glm::vec3& point_world) {
  const float area_px = static_cast<float>(camera.width_px) * static_cast<float>(camera.height_px);
  return std::sqrt(area_px) * glm::distance(camera.centre_world(), point_world) / camera.fx_px;
}

// How many times as broad as the picture the photographs are; 1 where that is not known.
float times_broader(const Camera& camera, std::span<const Camera> photographs, const glm::vec3& point_world) {
  const auto usual = photographed(photographs, point_world);
  return usual ? usual->breadth / std::max(breadth_at(camera, point_world), 1e-15f) : 1;
}

}  // namespace

std::optional<Photographed> photographed(std::span<const Camera> photographs, const glm::vec3& point_world) {
  std::vector<float> distances, breadths;
  for (const Camera& camera : photographs) {
    if (!camera.shows(point_world)) continue;
    distances.push_back(glm::distance(camera.centre_world(), point_world));
    breadths.push_back(breadth_at(camera, point_world));
  }
  if (std::ssize(distances) < kEnoughPhotographs) return std::nullopt;
  return Photographed{quantile(&distances, 0.5f), quantile(&breadths, 0.5f)};
}

bool is_close_up(const Camera& camera, std::span<const Camera> photographs, const glm::vec3& point_world) {
  return times_broader(camera, photographs, point_world) > kCloseUp;
}

Margins margins_of_close_up(const Camera& camera, std::span<const Camera> photographs,
                            const glm::vec3& point_world) {
  const float factor = times_broader(camera, photographs, point_world);
  if (!(factor > kCloseUp)) return {};
  const float margin = (std::min(factor, kWidest) - 1) / 2;
  const int beside_px = static_cast<int>(margin * static_cast<float>(camera.width_px));
  const int above_px = static_cast<int>(margin * static_cast<float>(camera.height_px));
  return {beside_px, above_px, beside_px, above_px};
}

}  // namespace splatcut
