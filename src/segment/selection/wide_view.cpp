#include "segment/selection/wide_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/ranks.h"

namespace splatcut {

namespace {

constexpr double kNotStrays = 0.96;  // of what is selected

struct Range {
  float low = 0, high = 0;
};

Range range_of(std::vector<float>* values) {
  return {quantile(values, (1 - kNotStrays) / 2), quantile(values, (1 + kNotStrays) / 2)};
}

// For what reaches so far beyond a side of a picture of that size.
int margin_for(float beyond_px, int size_px) {
  constexpr float kMore = 0.1f;  // of the picture
  constexpr int kSteps = 8;      // of the picture: views of corrections on one thing can be the same
  if (!(beyond_px > 0)) return 0;
  const float pictures = std::min(beyond_px / static_cast<float>(size_px) + kMore, 1.0f);
  return size_px * static_cast<int>(std::ceil(kSteps * pictures)) / kSteps;
}

}  // namespace

Margins margins_of_correction(const Camera& camera, const GaussianCloud& cloud,
                              std::span<const std::uint8_t> labels, const Capture& capture) {
  std::vector<glm::vec3> selected;
  std::vector<float> x_px, y_px;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (!labels[g]) continue;
    selected.push_back(cloud.position[g]);
    const glm::vec3 at = camera.camera_from_world(cloud.position[g]);
    if (!(at.z > cloud.near_plane)) continue;
    const glm::vec2 pixel = camera.pixel_from_camera(at);
    x_px.push_back(pixel.x);
    y_px.push_back(pixel.y);
  }
  if (selected.empty()) return {};
  Margins margins;
  if (!capture.photographs.empty())
    margins = margins_of_close_up(
        camera, usual_picture(camera, capture, robust_bounds(selected, kNotStrays).centre()));
  if (x_px.empty()) return margins;
  const Range x = range_of(&x_px), y = range_of(&y_px);
  const int width = camera.width_px, height = camera.height_px;
  margins.left_px = std::max(margins.left_px, margin_for(-x.low, width));
  margins.right_px = std::max(margins.right_px, margin_for(x.high - static_cast<float>(width), width));
  margins.top_px = std::max(margins.top_px, margin_for(-y.low, height));
  margins.bottom_px = std::max(margins.bottom_px, margin_for(y.high - static_cast<float>(height), height));
  return margins;
}

}  // namespace splatcut
