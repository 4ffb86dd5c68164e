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

}  // namespace

bool same_set(const SeenGaussians& a, const SeenGaussians& b) {
  return a == b || (a && b && *a == *b);
}

Stroke click(const glm::vec2& pixel, SeedLabel label) {
  return {label, 2, {pixel}};
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
