#include "segment/session/stroke_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatcut {

namespace {

constexpr int kScribbleWidthPx = 320;
constexpr float kReachShare = 1.0f / 80;  // of the picture's width: as far as a selection reaches

PixelRect around(const Camera& camera, const glm::vec2& pixel, int reach_px) {
  const int x = static_cast<int>(std::floor(pixel.x)), y = static_cast<int>(std::floor(pixel.y));
  return {std::clamp(x - reach_px, 0, camera.width_px), std::clamp(y - reach_px, 0, camera.height_px),
          std::clamp(x + reach_px + 1, 0, camera.width_px),
          std::clamp(y + reach_px + 1, 0, camera.height_px)};
}

// The hit of the pixel that shows something nearest to `pixel`. drawn: the pixels of `region`.
std::optional<glm::vec3> nearest_hit(const Camera& camera, const glm::vec2& pixel, const RasterOutput& drawn,
                                     const PixelRect& region, const PixelRect& within) {
  float nearest = std::numeric_limits<float>::infinity();
  std::optional<glm::vec3> hit;
  for (int y = within.y0; y < within.y1; ++y)
    for (int x = within.x0; x < within.x1; ++x) {
      if (drawn.first_hit.at(x - region.x0, y - region.y0) < 0) continue;
      const glm::vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float distance = glm::distance(centre, pixel);
      if (distance >= nearest) continue;
      nearest = distance;
      hit = camera.world_from_pixel(centre, drawn.median_depth.at(x - region.x0, y - region.y0));
    }
  return hit;
}

}  // namespace

StrokeHits stroke_hits(const Drawer& scene, const CameraStroke& stroke, const Job& job) {
  const std::vector<glm::vec2>& points = stroke.stroke.points_px;
  const Camera camera =
      points.size() == 1 ? stroke.camera : limited_to_width(stroke.camera, kScribbleWidthPx);
  const float scale = static_cast<float>(camera.width_px) / static_cast<float>(stroke.camera.width_px);
  const int reach_px = static_cast<int>(std::ceil(kReachShare * static_cast<float>(camera.width_px)));
  StrokeHits hits(points.size());
  PixelRect region{0, 0, camera.width_px, camera.height_px};
  if (points.size() == 1) region = around(camera, points.front(), reach_px);
  if (points.empty() || region.empty()) return hits;
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  options.roi = region;
  if (stroke.seen) options.shown = *stroke.seen;
  const RasterOutput drawn = scene.draw(camera, options, job);
  if (job.cancelled()) return hits;  // there is no picture
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec2 pixel = scale * points[i];
    hits[i] = nearest_hit(camera, pixel, drawn, region, around(camera, pixel, reach_px));
  }
  return hits;
}

}  // namespace splatcut
