#include "app/measure/robot_user.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "app/measure/mask_measures.h"
#include "core/counter_rng.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// Where the mask lacks what its label should be.
Mask wrong(const Mask& truth, const Mask& mask, SeedLabel label) {
  Mask wrong(truth.width(), truth.height());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool is = truth.pixels()[i], said = mask.pixels()[i];
    if (is != said && is == (label == SeedLabel::kObject)) wrong.pixels()[i] = kMaskObject;
  }
  return wrong;
}

}  // namespace

std::vector<WrongRegion> wrong_details(const Mask& truth, const Mask& mask, float least_px) {
  std::vector<WrongRegion> details;
  for (const SeedLabel label : {SeedLabel::kObject, SeedLabel::kRest})
    for (const std::vector<std::size_t>& pixels : regions(wrong(truth, mask, label))) {
      if (static_cast<float>(pixels.size()) < 4 * least_px * least_px) continue;
      WrongRegion region{Mask(truth.width(), truth.height()), pixels.size(), label};
      for (const std::size_t i : pixels) region.region.pixels()[i] = kMaskObject;
      if (std::ranges::max(distance_inside(region.region).pixels()) >= least_px)
        details.push_back(std::move(region));
    }
  return details;
}

WrongRegion wrong_region(const Mask& truth, const Mask& mask) {
  const Mask missing = wrong(truth, mask, SeedLabel::kObject), extra = wrong(truth, mask, SeedLabel::kRest);
  Mask most_missing = largest_region(missing), most_extra = largest_region(extra);
  const std::size_t missing_px = count(most_missing), extra_px = count(most_extra);
  if (missing_px >= extra_px) return {std::move(most_missing), missing_px, SeedLabel::kObject};
  return {std::move(most_extra), extra_px, SeedLabel::kRest};
}

std::optional<Stroke> click_in(const WrongRegion& wrong, std::uint64_t draw) {
  if (wrong.pixels == 0) return std::nullopt;
  const Image<float> depth = distance_inside(wrong.region);
  auto deepest = std::ranges::max_element(depth.pixels()) - depth.pixels().begin();
  if (draw != 0) {
    const float deep_enough = 0.5f * depth.pixels()[static_cast<std::size_t>(deepest)];
    std::vector<std::ptrdiff_t> pixels;
    for (std::size_t i = 0; i < depth.size(); ++i)
      if (depth.pixels()[i] >= deep_enough) pixels.push_back(static_cast<std::ptrdiff_t>(i));
    deepest = pixels[CounterRng(draw, pixels.size()).below(pixels.size())];
  }
  const auto column = deepest % depth.width(), row = deepest / depth.width();
  const glm::vec2 pixel(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f);
  return click(pixel, wrong.label);
}

std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask) {
  return robot_click(truth, mask, 0);
}

std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask, std::uint64_t draw) {
  return click_in(wrong_region(truth, mask), draw);
}

std::optional<Stroke> robot_box(const Mask& truth, float margin, std::uint64_t draw) {
  glm::ivec2 low(truth.width(), truth.height()), high(0);
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x)
      if (truth.at(x, y)) {
        low = glm::min(low, glm::ivec2(x, y));
        high = glm::max(high, glm::ivec2(x, y) + 1);
      }
  if (low.x >= high.x) return std::nullopt;
  CounterRng random(draw, 0);
  const auto side = [&] { return margin * (draw ? 2 * random.unit() : 1.0f); };
  const glm::vec2 extent(high - low);
  const float left = side(), top = side(), right = side(), bottom = side();
  return box_around(glm::vec2(low) - extent * glm::vec2(left, top),
                    glm::vec2(high) + extent * glm::vec2(right, bottom), SeedLabel::kObject);
}

}  // namespace splatcut
