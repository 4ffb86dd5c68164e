#include "segment/masks/mask_tools.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "core/parallel.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"
#include "segment/masks/cv_image.h"

namespace splatcut {

namespace {

cv::Mat disc(int radius_px) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius_px + 1, 2 * radius_px + 1});
}

// Nothing changes farther than the radius from the mask: only what lies nearer is looked at.
Mask changed_within(const Mask& mask, int radius_px, cv::MorphTypes how) {
  Mask out(mask.width(), mask.height());
  const PixelRect object = bounds(mask);
  if (object.empty()) return out;
  const cv::Rect near = as_rect(grown(object, radius_px, mask.width(), mask.height()));
  cv::morphologyEx(as_const_mat(mask)(near), as_mat(out)(near), how, disc(radius_px));
  return out;
}

}  // namespace

std::size_t count(const Mask& mask) {
  return static_cast<std::size_t>(
      std::ranges::count_if(mask.pixels(), [](std::uint8_t m) { return m != 0; }));
}

double iou(const Mask& a, const Mask& b) {
  assert(a.width() == b.width() && a.height() == b.height());
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a.pixels()[i] && b.pixels()[i];
    either += a.pixels()[i] || b.pixels()[i];
  }
  return either ? static_cast<double>(both) / static_cast<double>(either) : 1.0;
}

Mask dilated(const Mask& mask, int radius_px) {
  return changed_within(mask, radius_px, cv::MORPH_DILATE);
}

Mask eroded(const Mask& mask, int radius_px) {
  return changed_within(mask, radius_px, cv::MORPH_ERODE);
}

Mask resized_mask(const Mask& mask, int width_px, int height_px) {
  Mask out(width_px, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      out.at(x, y) = mask.at(static_cast<int>((x + 0.5) * mask.width() / width_px),
                             static_cast<int>((y + 0.5) * mask.height() / height_px));
  return out;
}

PixelRect bounds(const Mask& mask) {
  const cv::Rect r = cv::boundingRect(as_const_mat(mask));
  return {r.x, r.y, r.x + r.width, r.y + r.height};
}

PixelRect grown(const PixelRect& rect, int margin_px, int width, int height) {
  return {std::max(0, rect.x0 - margin_px), std::max(0, rect.y0 - margin_px),
          std::min(width, rect.x1 + margin_px), std::min(height, rect.y1 + margin_px)};
}

int width_to_see(const Mask& mask, int side_px, int most_width_px) {
  const double side = std::sqrt(static_cast<double>(count(mask)));
  if (side == 0 || side >= side_px || mask.width() >= most_width_px) return mask.width();
  const double steps = std::ceil(2 * std::log2(side_px / side));
  return std::min(most_width_px, static_cast<int>(std::ceil(mask.width() * std::exp2(steps / 2))));
}

Mask connected_to(const Mask& mask, const glm::ivec2& at) {
  constexpr int kReached = 1;
  static_assert(kReached != kMaskObject);
  Mask connected(mask);
  connected.at(at.x, at.y) = kMaskObject;
  cv::floodFill(as_mat(connected), {at.x, at.y}, kReached, nullptr, {}, {}, 4);
  for (std::uint8_t& pixel : connected.pixels()) pixel = pixel == kReached ? kMaskObject : 0;
  return connected;
}

Image<float> distance_inside(const Mask& mask) {
  Image<float> out(mask.width(), mask.height());
  const PixelRect box = bounds(mask);
  if (box.empty()) return out;
  const cv::Rect within = as_rect(box);
  cv::Mat framed, distance;
  cv::copyMakeBorder(as_const_mat(mask)(within), framed, 1, 1, 1, 1,
                     cv::BORDER_CONSTANT | cv::BORDER_ISOLATED, 0);
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  distance(cv::Rect(1, 1, box.width(), box.height())).copyTo(as_mat(out)(within));
  return out;
}

std::vector<std::vector<glm::vec2>> outlines(const Mask& mask, int least_px) {
  std::vector<std::vector<cv::Point>> borders;
  cv::findContours(as_const_mat(mask).clone(), borders, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::erase_if(borders, [&](const auto& border) { return cv::contourArea(border) < least_px; });
  std::ranges::stable_sort(borders, std::ranges::greater(),
                           [](const auto& border) { return cv::contourArea(border); });
  std::vector<std::vector<glm::vec2>> out;
  for (const auto& border : borders) {
    out.emplace_back();
    for (const cv::Point& p : border)
      out.back().push_back(glm::vec2(static_cast<float>(p.x), static_cast<float>(p.y)) + 0.5f);
  }
  return out;
}

PixelRect labelled_rectangle(const GaussianCloud& cloud, const Camera& camera,
                             std::span<const std::uint8_t> labels) {
  constexpr float kVisibleSigmas = 3.34f;  // sqrt(2 ln 255): beyond it alpha is below 1/255
  const float slope_x = kFrustumSlack * 0.5f * static_cast<float>(camera.width_px) / camera.fx_px;
  const float slope_y = kFrustumSlack * 0.5f * static_cast<float>(camera.height_px) / camera.fy_px;
  // The Jacobian's norm is at most focal length / z times this.
  const float bend = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    if (!labels[g]) continue;
    const glm::vec3 at = camera.camera_from_world(cloud.position[g]);
    if (at.z < near_plane_for(cloud, camera)) continue;
    const glm::vec3& scale = cloud.scale[g];
    const float sigma_px =
        std::max(camera.fx_px, camera.fy_px) / at.z * bend * std::max({scale.x, scale.y, scale.z});
    const float radius_px = kVisibleSigmas * std::sqrt(sigma_px * sigma_px + kLowPassPx2) + 1;
    const glm::vec2 centre = camera.pixel_from_camera(at);
    low = glm::min(low, centre - radius_px);
    high = glm::max(high, centre + radius_px);
  }
  const glm::vec2 size(camera.width_px, camera.height_px);
  low = glm::clamp(low, glm::vec2(0), size);
  high = glm::clamp(high, glm::vec2(0), size);
  const PixelRect rect{static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(std::ceil(high.x)),
                       static_cast<int>(std::ceil(high.y))};
  return rect.empty() ? PixelRect{} : rect;
}

Image<float> render_labels(const Drawer& drawer, const Camera& camera, std::span<const std::uint8_t> labels,
                           const Job& job) {
  Image<float> share(camera.width_px, camera.height_px);
  const PixelRect rect = labelled_rectangle(drawer.cloud(), camera, labels);
  if (rect.empty()) return share;
  RasterOptions options;
  options.colour = false;
  options.labels = labels;
  options.roi = rect;
  const RasterOutput picture = drawer.draw(camera, options, job);
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) share.at(x, y) = picture.label_share.at(x - rect.x0, y - rect.y0);
  return share;
}

Mask thresholded(const Image<float>& image, float threshold) {
  Mask mask(image.width(), image.height());
  std::ranges::transform(image.pixels(), mask.pixels().begin(),
                         [&](float v) { return v >= threshold ? kMaskObject : std::uint8_t{0}; });
  return mask;
}

}  // namespace splatcut
