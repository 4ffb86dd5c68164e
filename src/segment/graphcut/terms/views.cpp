// What the views say: source v_g w_g, sink v_g (1 - w_g), with the visibility v_g = min(1, A_g / v0), or 1
// without it; what was never seen has unseen_rest as its sink capacity.
#include <algorithm>

#include "segment/graphcut/energy.h"

namespace splatcut {

DataTerm views_term(const DataInput& input) {
  constexpr double kPixelsAt400 = 400.0 * 300.0;
  const double v0 = static_cast<double>(input.options.v0_px_per_view_at_400) *
                    static_cast<double>(std::max(1, input.views)) * input.pixels_per_view / kPixelsAt400;
  return [&likelihood = input.likelihood, &options = input.options, v0](std::size_t g) -> DataCapacities {
    if (!(likelihood.seen_px[g] > 0)) return {0, static_cast<double>(options.unseen_rest)};
    const double v = options.visibility && v0 > 0 ? std::min(1.0, likelihood.seen_px[g] / v0) : 1.0;
    return {v * likelihood.w[g], v * (1.0 - likelihood.w[g])};
  };
}

}  // namespace splatcut
