#include "app/measure/mask_disturbance.h"

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

}  // namespace

Mask disturbed(const Mask& mask, const MaskDisturbance& d) {
  if (d.kind == "none" || d.px == 0) return mask;
  if (d.kind == "erode") return eroded(mask, d.px);
  if (d.kind == "dilate") return dilated(mask, d.px);
  if (d.kind == "shift") return shifted(mask, d.px);
  if (d.kind == "empty") return Mask(mask.width(), mask.height());
  if (d.kind == "full") return Mask(mask.width(), mask.height(), kMaskObject);
  throw Error("mask disturbance " + d.kind, "there is no such kind",
              "Take none, erode, dilate, shift, empty or full");
}

}  // namespace splatcut
