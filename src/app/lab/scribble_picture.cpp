#include "app/lab/scribble_picture.h"

#include <algorithm>
#include <numeric>

#include "segment/masks/mask_tools.h"

namespace splatcut {

Strokes strokes_of_picture(const Mask& drawn, SeedLabel label) {
  const Image<float> depth = distance_inside(drawn);
  std::vector<std::size_t> thickest_first;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (drawn.pixels()[i]) thickest_first.push_back(i);
  std::ranges::stable_sort(
      thickest_first, [&](std::size_t a, std::size_t b) { return depth.pixels()[a] > depth.pixels()[b]; });
  const float least_apart = 0.01f * static_cast<float>(drawn.width());
  glm::dvec2 middle(0);
  for (const std::size_t i : thickest_first)
    middle +=
        glm::dvec2(i % static_cast<std::size_t>(drawn.width()), i / static_cast<std::size_t>(drawn.width())) /
        static_cast<double>(thickest_first.size());
  Mask covered(drawn.width(), drawn.height());
  Strokes strokes;
  for (const std::size_t i : thickest_first) {
    if (covered.pixels()[i]) continue;
    const int x = static_cast<int>(i) % drawn.width(), y = static_cast<int>(i) / drawn.width();
    const float radius = std::max(0.5f, depth.pixels()[i]), apart = std::max(2 * radius, least_apart);
    strokes.push_back({label, radius, {glm::vec2(x, y) + 0.5f}});
    const int reach = static_cast<int>(apart);
    for (int v = y - reach; v <= y + reach; ++v)
      for (int u = x - reach; u <= x + reach; ++u)
        if (covered.contains(u, v) &&
            static_cast<float>((u - x) * (u - x) + (v - y) * (v - y)) <= apart * apart)
          covered.at(u, v) = 1;
  }
  std::ranges::stable_sort(
      strokes, {}, [&](const Stroke& s) { return glm::distance(glm::dvec2(s.points_px.front()), middle); });
  return strokes;
}

}  // namespace splatcut
