// What the first strokes on an object say, where another place has answered them already.
#pragma once

#include <cstddef>

#include "segment/masks/seeds.h"

namespace splatcut {

struct CarriedLabels {
  std::size_t strokes = 0;  // so many of the strokes in replay order; 0: none
  SeenGaussians labels{};   // per Gaussian after these strokes by parts alone, 1 = object

  bool operator==(const CarriedLabels& other) const {
    return strokes == other.strokes && same_set(labels, other.labels);
  }
};

}  // namespace splatcut
