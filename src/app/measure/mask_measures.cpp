#include "app/measure/mask_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

Mask border_band(const Mask& mask, double band_px) {
  const Image<float> depth = distance_inside(mask);
  Mask band(mask.width(), mask.height());
  for (std::size_t i = 0; i < mask.size(); ++i)
    band.pixels()[i] = mask.pixels()[i] && depth.pixels()[i] <= band_px ? kMaskObject : 0;
  return band;
}

// Takes the region around a pixel out of `left`; returns its pixels.
std::vector<std::size_t> region_at(std::size_t first, Mask* left) {
  const int width = left->width(), height = left->height();
  std::vector<std::size_t> region{first};
  left->pixels()[first] = 0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    const int x = static_cast<int>(region[i]) % width, y = static_cast<int>(region[i]) / width;
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
        if (left->at(u, v)) {
          left->at(u, v) = 0;
          region.push_back(static_cast<std::size_t>(v) * width + u);
        }
  }
  return region;
}

}  // namespace

double pixel_accuracy(const Mask& a, const Mask& b) {
  std::size_t equal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) equal += !a.pixels()[i] == !b.pixels()[i];
  return a.empty() ? 1.0 : static_cast<double>(equal) / static_cast<double>(a.size());
}

double boundary_iou(const Mask& a, const Mask& b) {
  return boundary_iou(a, b, 0.02 * std::hypot(a.width(), a.height()));
}

double boundary_iou(const Mask& a, const Mask& b, double band_px) {
  return iou(border_band(a, band_px), border_band(b, band_px));
}

std::vector<std::vector<std::size_t>> regions(const Mask& mask) {
  Mask left = mask;
  std::vector<std::vector<std::size_t>> all;
  for (std::size_t i = 0; i < left.size(); ++i)
    if (left.pixels()[i]) all.push_back(region_at(i, &left));
  return all;
}

Mask largest_region(const Mask& mask) {
  Mask out(mask.width(), mask.height());
  const std::vector<std::vector<std::size_t>> all = regions(mask);
  if (all.empty()) return out;
  for (const std::size_t i : *std::ranges::max_element(all, {}, &std::vector<std::size_t>::size))
    out.pixels()[i] = kMaskObject;
  return out;
}

}  // namespace splatcut
