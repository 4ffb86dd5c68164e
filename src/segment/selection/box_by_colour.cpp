#include "segment/selection/box_by_colour.h"

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "segment/masks/cv_image.h"
#include "segment/masks/refine_mask.h"
#include "segment/selection/box_meanings.h"
#include "segment/superpoints/part_view.h"

namespace splatcut {

namespace {

Mask mask_of_box(const BoxPx& box, int width_px, int height_px) {
  Mask mask(width_px, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      if (box.contains(glm::vec2(x, y) + 0.5f)) mask.at(x, y) = kMaskObject;
  return mask;
}

std::size_t colour_bin(const cv::Vec3f& lab) {
  constexpr float kMostChroma = 40;
  const auto eighth = [](float value, float low, float high) {
    return static_cast<std::size_t>(std::clamp(8 * (value - low) / (high - low), 0.0f, 7.0f));
  };
  return (eighth(lab[0], 0, 100) * 8 + eighth(lab[1], -kMostChroma, kMostChroma)) * 8 +
         eighth(lab[2], -kMostChroma, kMostChroma);
}

// Overlap of the colours in the mask and beside it in the box grown by a quarter: 0 apart, 1 the same.
float overlap_of_colours(const cv::Mat& lab, const Mask& mask, const BoxPx& box) {
  const glm::vec2 margin_px = 0.25f * box.size_px();
  const BoxPx around{box.low_px - margin_px, box.high_px + margin_px};
  std::array<std::array<float, 512>, 2> pixels{};
  std::array<float, 2> all{};
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (!around.contains(glm::vec2(x, y) + 0.5f)) continue;
      const std::size_t side = mask.at(x, y) != 0;
      pixels[side][colour_bin(lab.at<cv::Vec3f>(y, x))] += 1;
      all[side] += 1;
    }
  if (all[0] == 0 || all[1] == 0) return 1;
  float overlap = 0;
  for (std::size_t bin = 0; bin < pixels[0].size(); ++bin)
    overlap += std::min(pixels[0][bin] / all[0], pixels[1][bin] / all[1]);
  return overlap;
}

}  // namespace

std::vector<std::uint8_t> leaves_by_colour(const PartHierarchy& parts, const LeafView& view,
                                           const Stroke& box, const MaskToPartsOptions& options) {
  if (view.colour.empty()) return std::vector<std::uint8_t>(parts.leaves, 0);
  const int width_px = view.camera.width_px, height_px = view.camera.height_px;
  const BoxPx inside = box_in_picture(box, width_px, height_px);
  RefineOptions refine;
  refine.iterations = 5;
  refine.band_px = static_cast<int>(std::max(inside.size_px().x, inside.size_px().y));  // all of the box
  const Mask mask = refine_mask(view.colour, view.depth, mask_of_box(inside, width_px, height_px), refine,
                                draw_seeds({box}, width_px, height_px));
  return parts_of_mask(parts, view_parts(parts, picture_of(view).leaf), mask, options);
}

bool stands_out_more(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                     std::span<const std::uint8_t> by_colour, std::span<const std::uint8_t> others,
                     const TermValues& weights) {
  constexpr float kOverlap = 2, kLeast = 0.4f;
  if (view.colour.empty() || std::ranges::count(by_colour, 1) == 0) return false;
  const cv::Mat lab = lab_of(as_const_mat(view.colour));
  const auto cost = [&](std::span<const std::uint8_t> leaves) {
    return cost_in_box(parts, view, box, leaves, weights) +
           kOverlap * overlap_of_colours(lab, shown(view.leaves, view.camera, leaves), box);
  };
  return cost(others) - cost(by_colour) > kLeast;
}

}  // namespace splatcut
