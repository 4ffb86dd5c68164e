// What the masks say of each Gaussian: w_g = M_g / A_g and how much of it was ever seen.
// Source: Jain et al., GaussianCut, NeurIPS 2024, eq. 1-2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/raster/projected_view.h"

namespace splatcut {

struct Likelihood {
  std::vector<float> w;        // [0, 1]; 0 where nothing was seen
  std::vector<float> seen_px;  // A_g over all views, pixels
};

// Adds one view's A_g and M_g to `sums`. mask: of the camera's size. whole_pixels: see RasterOptions.
void add_masked_sums(const Drawer& drawer, const Camera& camera, const Mask& mask, bool whole_pixels,
                     const Job& job, MaskedSums* sums);

Likelihood likelihood(const MaskedSums& sums);

// Adds a prior label per Gaussian (1 = object; empty: none) as if prior_px more pixels of it had been seen.
Likelihood with_prior(Likelihood seen, std::span<const std::uint8_t> prior, float prior_px);

}  // namespace splatcut
