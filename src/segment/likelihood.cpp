#include "segment/likelihood.h"

namespace splatcut {

Likelihood likelihood(const MaskedSums& sums) {
  Likelihood out;
  out.w.resize(sums.total.size());
  out.seen_px.resize(sums.total.size());
  for (std::size_t g = 0; g < sums.total.size(); ++g) {
    const auto total = static_cast<double>(sums.total[g]);
    out.w[g] = total > 0 ? static_cast<float>(static_cast<double>(sums.inside[g]) / total) : 0.0f;
    out.seen_px[g] = static_cast<float>(total / MaskedSums::kUnitsPerPixel);
  }
  return out;
}

}  // namespace splatcut
