// Measures of masks against their truth.
#pragma once

#include <cstddef>
#include <vector>

#include "core/image.h"

namespace splatcut {

double pixel_accuracy(const Mask& a, const Mask& b);  // share of equal pixels
// IoU of the bands within 2 % of the diagonal of each mask's border (Cheng et al., Boundary IoU, 2021).
double boundary_iou(const Mask& a, const Mask& b);
double boundary_iou(const Mask& a, const Mask& b, double band_px);  // of bands that wide

// The indices of the pixels of each 8-connected region, in the order of rows by the first one.
std::vector<std::vector<std::size_t>> regions(const Mask& mask);
// The largest 8-connected region, the first one in the order of rows if several are as large.
Mask largest_region(const Mask& mask);

}  // namespace splatcut
