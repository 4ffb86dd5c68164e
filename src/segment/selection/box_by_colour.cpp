#include "segment/selection/box_by_colour.h"

#include <algorithm>

#include "segment/masks/colour_overlap.h"
#include "segment/masks/refine_mask.h"
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

}  // namespace

std::vector<std::uint8_t> leaves_by_colour(const PartHierarchy& parts, const LeafView& view,
                                           const Stroke& box) {
  if (view.colour.empty()) return std::vector<std::uint8_t>(parts.leaves, 0);
  const int width_px = view.camera.width_px, height_px = view.camera.height_px;
  const BoxPx inside = box_in_picture(box, width_px, height_px);
  RefineOptions refine;
  refine.iterations = 5;
  refine.band_px = static_cast<int>(std::max(inside.size_px().x, inside.size_px().y));  // all of the box
  const Mask mask = refine_mask(view.colour, view.depth, mask_of_box(inside, width_px, height_px), refine,
                                draw_seeds({box}, width_px, height_px));
  return parts_of_mask(parts, view_parts(parts, view.leaf), mask);
}

const std::vector<std::uint8_t>& KnownByColour::of(const PartHierarchy& parts, const LeafView& view,
                                                   const Stroke& box) {
  if (box_px != box.points_px) {
    leaves = leaves_by_colour(parts, view, box);
    box_px = box.points_px;
  }
  return leaves;
}

bool stands_out_more(const BoxMeanings& meanings, const LeafView& view, const BoxPx& box,
                     std::span<const std::uint8_t> by_colour, std::span<const std::uint8_t> others) {
  constexpr float kOverlap = 4, kLeast = 0.55f;
  if (view.colour.empty() || std::ranges::count(by_colour, 1) == 0) return false;
  const glm::vec2 margin_px = 0.25f * box.size_px();
  const BoxPx around{box.low_px - margin_px, box.high_px + margin_px};
  const Image<std::uint16_t> colour = view.colour_bins.empty() ? colour_bins(view.colour) : view.colour_bins;
  const auto cost = [&](std::span<const std::uint8_t> leaves) {
    return meanings.cost(leaves) +
           kOverlap * overlap_of_colours(colour, shown(view.leaves, view.camera, leaves), around);
  };
  return cost(others) - cost(by_colour) > kLeast;
}

}  // namespace splatcut
