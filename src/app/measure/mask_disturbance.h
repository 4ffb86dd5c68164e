// Masks made worse on purpose, to see what a method stands.
#pragma once

#include <string>

#include "core/image.h"

namespace splatcut {

struct MaskDisturbance {
  // none, erode, dilate, shift (to the right), empty, full
  std::string kind = "none";
  int px = 0;
};

// Throws Error for an unknown kind.
Mask disturbed(const Mask& mask, const MaskDisturbance& disturbance);

}  // namespace splatcut
