#include "segment/session/cut_result.h"

namespace splatcut {

LookedAt looked_at(const std::vector<ViewReport>& views) {
  LookedAt sum;
  for (const ViewReport& view : views)
    if (view.used) {
      ++sum.views;
      sum.pixels += view.mask.size();
    }
  return sum;
}

}  // namespace splatcut
