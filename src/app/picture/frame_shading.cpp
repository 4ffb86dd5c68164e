#include "app/picture/frame_shading.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace splatcut {

namespace {

glm::vec3 unit(const Rgb8& c) {
  return glm::vec3(c[0], c[1], c[2]) / 255.0f;
}

// The hue as bright as the picture, but never dark: an orange tint on blue is orange, not brown.
glm::vec3 shaded_tint(const glm::vec3& hue, const glm::vec3& colour) {
  return hue * (0.7f + 0.5f * glm::dot(colour, glm::vec3(0.299f, 0.587f, 0.114f)));
}

Rgba8 rgba8(const glm::vec3& c) {
  const glm::vec3 v = glm::clamp(c, 0.0f, 1.0f) * 255.0f + 0.5f;
  return {static_cast<std::uint8_t>(v.r), static_cast<std::uint8_t>(v.g), static_cast<std::uint8_t>(v.b),
          255};
}

// What the 5 x 5 pixels around one hold.
struct Around {
  std::uint8_t owner = 0;  // the object most of the marked neighbours belong to
  float inside = 0;        // share of neighbours that belong to any object, [0, 1]
  bool uniform = true;     // all neighbours alike
};

Around around(const Image<std::uint8_t>& owners, int x, int y) {
  const int x0 = std::max(0, x - 2), x1 = std::min(owners.width() - 1, x + 2);
  const int y0 = std::max(0, y - 2), y1 = std::min(owners.height() - 1, y + 2);
  const std::uint8_t *above = owners.row(y0).data(), *own = owners.row(y).data(),
                     *below = owners.row(y1).data();
  const std::uint8_t centre = own[x];
  // Corners and edge middles decide for most pixels that nothing happens here.
  const bool quiet = above[x0] == centre && above[x] == centre && above[x1] == centre && own[x0] == centre &&
                     own[x1] == centre && below[x0] == centre && below[x] == centre && below[x1] == centre;
  if (quiet) return {centre, centre ? 1.0f : 0.0f, true};
  int marked = 0, total = 0, same = 0;
  std::uint8_t other = centre;
  for (int v = y0; v <= y1; ++v)
    for (int u = x0; u <= x1; ++u) {
      const std::uint8_t o = owners.at(u, v);
      ++total;
      marked += o != 0;
      same += o == centre;
      if (o != 0 && other == 0) other = o;
    }
  return {centre ? centre : other, static_cast<float>(centre ? same : marked) / static_cast<float>(total),
          false};
}

// 1 on the border between inside and outside, falling to 0 about 1.5 px away.
float border(float inside) {
  return std::clamp(1.0f - std::abs(inside - 0.5f) / 0.32f, 0.0f, 1.0f);
}

}  // namespace

Image<std::uint8_t> owners_of(const Frame& frame, const Flags& owner) {
  Image<std::uint8_t> out(frame.first_hit.width(), frame.first_hit.height());
  if (!owner) return out;
  std::ranges::transform(frame.first_hit.pixels(), out.pixels().begin(), [&](std::int32_t g) {
    return g >= 0 ? (*owner)[static_cast<std::size_t>(g)] : std::uint8_t{0};
  });
  return out;
}

glm::vec3 heat_colour(float value) {
  constexpr std::array<glm::vec3, 5> kStops = {glm::vec3(0.16f, 0.2f, 0.55f), glm::vec3(0.1f, 0.55f, 0.75f),
                                               glm::vec3(0.55f, 0.8f, 0.4f), glm::vec3(0.98f, 0.78f, 0.22f),
                                               glm::vec3(0.85f, 0.16f, 0.12f)};
  const float t = std::clamp(value, 0.0f, 1.0f) * (kStops.size() - 1);
  const auto i = std::min<std::size_t>(kStops.size() - 2, static_cast<std::size_t>(t));
  return glm::mix(kStops[i], kStops[i + 1], t - static_cast<float>(i));
}

glm::vec3 checker_colour(int x, int y, float side_px) {
  constexpr float kLight = 0.62f, kDark = 0.42f;
  const glm::ivec2 square((glm::vec2(x, y) + 0.5f) / side_px);
  return glm::vec3((square.x + square.y) % 2 == 0 ? kLight : kDark);
}

Image<Rgba8> shaded(const Frame& frame, const FrameStyle& style, const Image<std::uint8_t>* known_owners) {
  const int width = frame.colour.width(), height = frame.colour.height();
  Image<Rgba8> picture(width, height);
  const Image<std::uint8_t> of_hits = known_owners ? Image<std::uint8_t>() : owners_of(frame, style.owner);
  const Image<std::uint8_t>& owners = known_owners ? *known_owners : of_hits;
  const Image<std::uint8_t> highlights = owners_of(frame, style.highlight);
  tbb::parallel_for(0, height, [&](int y) {
    const auto colours = frame.colour.row(y);
    const auto alphas = frame.alpha.row(y);
    const auto hits = frame.first_hit.row(y);
    const auto row = picture.row(y);
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const glm::vec3 behind =
          style.checker_px > 0 ? checker_colour(x, y, style.checker_px) : style.background;
      glm::vec3 c = colours[i] + (1 - alphas[i]) * behind;
      const std::int32_t hit = hits[i];
      if (style.heat && hit >= 0)
        c = glm::mix(c, heat_colour((*style.heat)[static_cast<std::size_t>(hit)]), kHeatStrength);
      if (style.owner && (style.tint || style.outline)) {
        const Around a = around(owners, x, y);
        const glm::vec3 hue = unit(style.owner_colour[a.owner]);
        if (style.tint && !style.heat) c = glm::mix(c, shaded_tint(hue, c), kTintStrength * a.inside);
        if (style.outline && !a.uniform)
          c = glm::mix(c, glm::mix(hue, glm::vec3(1), 0.35f), kOutlineStrength * border(a.inside));
      }
      if (style.highlight) {
        const Around a = around(highlights, x, y);
        c = glm::mix(c, unit(style.highlight_colour), a.uniform ? 0.14f * a.inside : 0.9f * border(a.inside));
      }
      row[i] = rgba8(c);
    }
  });
  return picture;
}

}  // namespace splatcut
