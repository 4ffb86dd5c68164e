#include "segment/selection/levels_in_view.h"

#include <algorithm>

#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

PixelRect around_both(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

PixelRect around(const glm::ivec2& pixel) {
  return {pixel.x, pixel.y, pixel.x + 1, pixel.y + 1};
}

}  // namespace

LevelsInView levels_in_view(const LeafView& view, std::span<const std::uint32_t> joins, std::size_t indices) {
  LevelsInView levels{shown_from(view, joins), std::vector<PixelRect>(indices)};
  const Image<std::uint32_t>& of_pixel = levels.of_pixel;
  for (int y = 0; y < of_pixel.height(); ++y) {
    const auto row = of_pixel.row(y);
    for (auto run = row.begin(), end = run; run != row.end(); run = end) {  // of one index
      end = std::find_if(run, row.end(), [&](std::uint32_t index) { return index != *run; });
      const auto x0 = static_cast<int>(run - row.begin()), x1 = static_cast<int>(end - row.begin());
      if (*run != kNoLevel) levels.box[*run] = around_both(levels.box[*run], {x0, y, x1, y + 1});
    }
  }
  for (std::size_t i = 1; i < indices; ++i) levels.box[i] = around_both(levels.box[i], levels.box[i - 1]);
  return levels;
}

float centrality(const LevelsInView& levels, std::size_t index, const glm::ivec2& at) {
  const PixelRect box = around_both(levels.box[index], around(at));
  Mask region(box.width(), box.height());
  for (int y = 0; y < box.height(); ++y)
    for (int x = 0; x < box.width(); ++x)
      region.at(x, y) = levels.of_pixel.at(box.x0 + x, box.y0 + y) <= index ? kMaskObject : 0;
  const glm::ivec2 here = at - glm::ivec2(box.x0, box.y0);
  const Image<float> distance = distance_inside(connected_to(region, here));
  return distance.at(here.x, here.y) / std::ranges::max(distance.pixels());
}

}  // namespace splatcut
