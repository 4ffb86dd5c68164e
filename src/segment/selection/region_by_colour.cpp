#include "segment/selection/region_by_colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "segment/masks/colour_overlap.h"
#include "segment/masks/mask_tools.h"
#include "segment/masks/refine_mask.h"

namespace splatcut {

namespace {

// Pixels that are in the one and not in the other.
Mask without(const Mask& all, const Mask& some) {
  Mask left(all.width(), all.height());
  for (std::size_t i = 0; i < left.size(); ++i)
    left.pixels()[i] = all.pixels()[i] && !some.pixels()[i] ? kMaskObject : 0;
  return left;
}

}  // namespace

Mask region_by_colour(const Click& click, std::span<const std::uint32_t> disc, float more_than_px) {
  constexpr float kAtBorderPx = 6, kBand = 3, kMostBandPx = 40, kMostDiscs = 20, kDiffers = 0.45f;
  const Mask& displayed = click.displayed;
  const Image<Rgb8>& colour = click.view.colour;
  Mask nothing(displayed.width(), displayed.height());
  const float disc_px = std::numbers::pi_v<float> * click.radius_px * click.radius_px;
  if (click.object || colour.empty() || click.radius_px <= kAtBorderPx ||
      more_than_px >= kMostDiscs * disc_px)
    return nothing;
  Image<std::uint8_t> seeds(displayed.width(), displayed.height(), kNoSeed);
  for (const std::uint32_t pixel : disc) seeds.pixels()[pixel] = kRestSeed;
  RefineOptions refine;
  refine.band_px = static_cast<int>(std::min(kBand * click.radius_px, kMostBandPx));
  const Mask left = refine_mask(colour, click.view.depth, displayed, refine, seeds);
  Mask region = connected_to(without(displayed, left), click.at);
  const float differs = log_ratio_of_colours(
      colour, region, without(dilated(displayed, refine.band_px), displayed), without(displayed, region));
  const auto region_px = static_cast<float>(count(region));
  const float discs = region_px / disc_px;
  const bool found = region_px > more_than_px && discs < kMostDiscs && differs > kDiffers * std::log(discs);
  return found ? region : nothing;
}

}  // namespace splatcut
