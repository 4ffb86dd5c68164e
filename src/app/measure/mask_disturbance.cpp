#include "app/measure/mask_disturbance.h"

#include "core/counter_rng.h"
#include "core/error.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

Mask shifted(const Mask& mask, int right_px) {
  Mask out(mask.width(), mask.height());
  for (int y = 0; y < mask.height(); ++y)
    for (int x = right_px; x < mask.width(); ++x) out.at(x, y) = mask.at(x - right_px, y);
  return out;
}

Mask with_holes(Mask mask, int radius_px, std::uint64_t seed) {
  CounterRng random(seed, 0x401e5);
  const int pitch = 3 * radius_px;
  for (int cy = 0; cy < mask.height() + pitch; cy += pitch)
    for (int cx = 0; cx < mask.width() + pitch; cx += pitch) {
      if (random.below(3) != 0) continue;
      for (int y = cy - radius_px; y <= cy + radius_px; ++y)
        for (int x = cx - radius_px; x <= cx + radius_px; ++x)
          if (mask.contains(x, y) && (x - cx) * (x - cx) + (y - cy) * (y - cy) <= radius_px * radius_px)
            mask.at(x, y) = 0;
    }
  return mask;
}

}  // namespace

Mask disturbed(const Mask& mask, const MaskDisturbance& d, std::uint64_t seed) {
  if (d.kind == "none" || d.px == 0) return mask;
  if (d.kind == "erode") return eroded(mask, d.px);
  if (d.kind == "dilate") return dilated(mask, d.px);
  if (d.kind == "shift") return shifted(mask, d.px);
  if (d.kind == "holes") return with_holes(mask, d.px, seed);
  if (d.kind == "empty") return Mask(mask.width(), mask.height());
  if (d.kind == "full") return Mask(mask.width(), mask.height(), kMaskObject);
  throw Error("mask disturbance " + d.kind, "there is no such kind",
              "Take none, erode, dilate, shift, holes, empty or full");
}

}  // namespace splatcut
