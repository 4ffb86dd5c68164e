#include "segment/masks/seeds.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

namespace {

void draw_disc(const glm::vec2& centre, float radius, std::uint8_t value, Image<std::uint8_t>* seeds) {
  const auto within = [](float v, int size) {
    return static_cast<int>(std::clamp(v, -1.0f, static_cast<float>(size)));
  };
  const int x0 = within(std::floor(centre.x - radius), seeds->width()),
            x1 = within(std::ceil(centre.x + radius), seeds->width());
  const int y0 = within(std::floor(centre.y - radius), seeds->height()),
            y1 = within(std::ceil(centre.y + radius), seeds->height());
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const glm::vec2 d = glm::vec2(x, y) + 0.5f - centre;
      const bool own_pixel =
          x == static_cast<int>(std::floor(centre.x)) && y == static_cast<int>(std::floor(centre.y));
      if (seeds->contains(x, y) && (own_pixel || glm::dot(d, d) <= radius * radius)) seeds->at(x, y) = value;
    }
}

void draw_box(const Stroke& stroke, Image<std::uint8_t>* seeds) {
  const BoxPx box = box_in_picture(stroke, seeds->width(), seeds->height());
  const bool object = stroke.label == SeedLabel::kObject;
  for (int y = 0; y < seeds->height(); ++y)
    for (int x = 0; x < seeds->width(); ++x)
      if (box.contains(glm::vec2(x, y) + 0.5f) != object) seeds->at(x, y) = kRestSeed;
  if (!object) return;
  constexpr float kMiddleShare = 0.12f;  // of the shorter side
  const glm::vec2 size = box.size_px();
  draw_disc(0.5f * (box.low_px + box.high_px), std::max(2.0f, kMiddleShare * std::min(size.x, size.y)),
            kObjectSeed, seeds);
}

}  // namespace

bool same_set(const SeenGaussians& a, const SeenGaussians& b) {
  return a == b || (a && b && *a == *b);
}

Stroke click(const glm::vec2& pixel, SeedLabel label) {
  return {label, 2, {pixel}};
}

Stroke box_around(const glm::vec2& corner_px, const glm::vec2& opposite_px, SeedLabel label) {
  return {label, 2, {corner_px, opposite_px}, StrokeKind::kBox};
}

BoxPx box_in_picture(const Stroke& box, int width_px, int height_px) {
  const glm::vec2 &a = box.points_px[0], &b = box.points_px[1], most(width_px, height_px);
  return {glm::clamp(glm::min(a, b), glm::vec2(0), most), glm::clamp(glm::max(a, b), glm::vec2(0), most)};
}

bool box_is_too_small(const Stroke& box, int width_px, int height_px) {
  constexpr float kSmallestPx = 6;
  const glm::vec2 size = box_in_picture(box, width_px, height_px).size_px();
  return !(size.x >= kSmallestPx && size.y >= kSmallestPx);
}

Strokes scaled(const Strokes& strokes, float factor) {
  Strokes out = strokes;
  for (Stroke& stroke : out) {
    stroke.radius_px *= factor;
    for (glm::vec2& point : stroke.points_px) point *= factor;
  }
  return out;
}

Image<std::uint8_t> draw_seeds(const Strokes& strokes, int width, int height) {
  Image<std::uint8_t> seeds(width, height, kNoSeed);
  for (const Stroke& stroke : strokes) {
    if (stroke.is_box()) {
      draw_box(stroke, &seeds);
      continue;
    }
    const std::uint8_t value = stroke.label == SeedLabel::kObject ? kObjectSeed : kRestSeed;
    for (std::size_t i = 0; i < stroke.points_px.size(); ++i) {
      const glm::vec2 from = stroke.points_px[i > 0 ? i - 1 : 0], to = stroke.points_px[i];
      const int steps = std::max(1, static_cast<int>(std::ceil(glm::length(to - from))));
      for (int s = 0; s <= steps; ++s)
        draw_disc(glm::mix(from, to, static_cast<float>(s) / static_cast<float>(steps)), stroke.radius_px,
                  value, &seeds);
    }
  }
  return seeds;
}

}  // namespace splatcut
