#include "segment/graphcut/likelihood.h"

#include "core/parallel.h"

namespace splatcut {

void add_masked_sums(const Drawer& drawer, const Camera& camera, const Mask& mask, bool whole_pixels,
                     const Job& job, MaskedSums* sums) {
  RasterOptions options;
  options.colour = false;
  options.sum_whole_pixels = whole_pixels;
  options.sum_mask = &mask;
  options.sums = sums;
  drawer.draw(camera, options, job);
}

Likelihood likelihood(const MaskedSums& sums) {
  Likelihood out;
  out.w.resize(sums.total.size());
  out.seen_px.resize(sums.total.size());
  for_each_index(sums.total.size(), [&](std::size_t g) {
    const auto total = static_cast<double>(sums.total[g]);
    out.w[g] = total > 0 ? static_cast<float>(static_cast<double>(sums.inside[g]) / total) : 0.0f;
    out.seen_px[g] = static_cast<float>(total / MaskedSums::kUnitsPerPixel);
  });
  return out;
}

Likelihood with_prior(Likelihood seen, std::span<const std::uint8_t> prior, float prior_px) {
  if (!(prior_px > 0)) return seen;
  for_each_index(prior.size(), [&](std::size_t g) {
    const float all = seen.seen_px[g] + prior_px;
    seen.w[g] = (seen.w[g] * seen.seen_px[g] + (prior[g] ? prior_px : 0)) / all;
    seen.seen_px[g] = all;
  });
  return seen;
}

}  // namespace splatcut
