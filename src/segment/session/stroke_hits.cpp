#include "segment/session/stroke_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splatcut {

namespace {

constexpr int kWidthPx = 320;             // of the picture for scribbles and boxes
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

RasterOptions depth_of(const CameraStroke& stroke, const PixelRect& region) {
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  options.roi = region;
  if (stroke.seen) options.shown = *stroke.seen;
  return options;
}

// In how many steps the way between two points of a path is sampled.
int steps_between(const Camera& camera, const glm::vec2& from, const glm::vec2& to) {
  constexpr float kMostSteps = 16 * kWidthPx;  // what leads far out of the picture hits nothing there
  const float steps = glm::distance(from, to) * static_cast<float>(kWidthPx) /
                      static_cast<float>(std::max(camera.width_px, kWidthPx));
  return std::max(1, static_cast<int>(std::ceil(std::min(kMostSteps, steps))));
}

// Each point of sampled(stroke), in order: add(point, whether it is one of the path's own).
void for_each_sample(const CameraStroke& stroke, const auto& add) {
  const std::vector<glm::vec2>& points = stroke.stroke.points_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int steps = i > 0 ? steps_between(stroke.camera, points[i - 1], points[i]) : 1;
    for (int s = 1; s < steps; ++s)
      add(glm::mix(points[i - 1], points[i], static_cast<float>(s) / static_cast<float>(steps)), false);
    add(points[i], true);
  }
}

StrokeHits hits_of_path(const Drawer& scene, const CameraStroke& stroke, const Job& job) {
  const std::vector<glm::vec2>& points = stroke.stroke.points_px;
  const Camera camera = points.size() == 1 ? stroke.camera : limited_to_width(stroke.camera, kWidthPx);
  const float scale = static_cast<float>(camera.width_px) / static_cast<float>(stroke.camera.width_px);
  const int reach_px = static_cast<int>(std::ceil(kReachShare * static_cast<float>(camera.width_px)));
  StrokeHits hits(points.size());
  PixelRect region{0, 0, camera.width_px, camera.height_px};
  if (points.size() == 1) region = around(camera, points.front(), reach_px);
  if (points.empty() || region.empty()) return hits;
  const RasterOutput drawn = scene.draw(camera, depth_of(stroke, region), job);
  if (job.cancelled()) return hits;  // there is no picture
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec2 pixel = scale * points[i];
    hits[i] = nearest_hit(camera, pixel, drawn, region, around(camera, pixel, reach_px));
  }
  return hits;
}

StrokeHits hits_of_box(const Drawer& scene, const CameraStroke& stroke, const Job& job) {
  constexpr int kGrid = 16;               // places a side
  constexpr std::size_t kNearerThan = 4;  // of them one is as near as what is meant
  const Camera camera = limited_to_width(stroke.camera, kWidthPx);
  const float scale = static_cast<float>(camera.width_px) / static_cast<float>(stroke.camera.width_px);
  const BoxPx box = box_in_picture(scaled({stroke.stroke}, scale).front(), camera.width_px, camera.height_px);
  const PixelRect region{static_cast<int>(box.low_px.x), static_cast<int>(box.low_px.y),
                         static_cast<int>(std::ceil(box.high_px.x)),
                         static_cast<int>(std::ceil(box.high_px.y))};
  if (region.empty()) return {};
  const RasterOutput drawn = scene.draw(camera, depth_of(stroke, region), job);
  if (job.cancelled()) return {};
  std::vector<glm::vec3> seen;  // pixel, camera z
  const glm::vec2 step = box.size_px() / static_cast<float>(kGrid);
  for (int row = 0; row < kGrid; ++row)
    for (int column = 0; column < kGrid; ++column) {
      const glm::vec2 at = box.low_px + step * (glm::vec2(column, row) + 0.5f);
      const int x = static_cast<int>(at.x) - region.x0, y = static_cast<int>(at.y) - region.y0;
      if (drawn.first_hit.at(x, y) >= 0) seen.emplace_back(at, drawn.median_depth.at(x, y));
    }
  if (seen.empty()) return {};
  std::ranges::sort(seen, {}, &glm::vec3::z);
  const float depth = seen[seen.size() / kNearerThan].z;
  const float extent = depth * std::max(box.size_px().x / camera.fx_px, box.size_px().y / camera.fy_px);
  StrokeHits hits;
  for (const glm::vec3& pixel : seen)
    if (std::abs(pixel.z - depth) <= extent) hits.emplace_back(camera.world_from_pixel(pixel, pixel.z));
  return hits;
}

}  // namespace

StrokeHits stroke_hits(const Drawer& scene, const CameraStroke& stroke, const Job& job) {
  return stroke.stroke.is_box() ? hits_of_box(scene, stroke, job) : hits_of_path(scene, stroke, job);
}

Stroke sampled(const CameraStroke& stroke) {
  if (stroke.stroke.is_box()) return stroke.stroke;
  Stroke finer = stroke.stroke;
  finer.points_px.clear();
  for_each_sample(stroke, [&](const glm::vec2& point, bool) { finer.points_px.push_back(point); });
  return finer;
}

Strokes pieces_in(const Box& box_world, const CameraStroke& stroke, const StrokeHits& hits) {
  const auto lies_in = [&](const auto& hit) { return hit && contains(box_world, *hit); };
  if (stroke.stroke.is_box() || stroke.stroke.is_click())
    return std::ranges::any_of(hits, lies_in) ? Strokes{stroke.stroke} : Strokes{};
  struct Sample {
    glm::vec2 px;
    bool own;
    float along_px;
  };
  struct Piece {
    std::size_t first, last;  // of the samples
  };
  const float covered_px = 2 * stroke.stroke.radius_px;  // by the ends of two pieces
  std::vector<Sample> samples;
  std::vector<Piece> found;
  for_each_sample(stroke, [&](const glm::vec2& px, bool own) {
    const std::size_t i = samples.size();
    const float along_px = i == 0 ? 0 : samples[i - 1].along_px + glm::distance(samples[i - 1].px, px);
    samples.push_back({px, own, along_px});
    if (i >= hits.size() || !lies_in(hits[i])) return;
    const bool adjoins = !found.empty() && (found.back().last + 1 == i ||
                                            along_px - samples[found.back().last].along_px <= covered_px);
    if (adjoins)
      found.back().last = i;
    else
      found.push_back({i, i});
  });
  Strokes pieces;
  for (const Piece& piece : found) {
    pieces.push_back(stroke.stroke);
    std::vector<glm::vec2>& points = pieces.back().points_px;
    points.clear();
    for (std::size_t i = piece.first; i <= piece.last; ++i)
      if (samples[i].own || i == piece.first || i == piece.last) points.push_back(samples[i].px);
    if (points.size() == 1) points.push_back(points.front());  // one point alone would be a click
  }
  return pieces;
}

}  // namespace splatcut
