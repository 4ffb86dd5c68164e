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

void obey_strokes(CutResult* result) {
  for (std::size_t g = 0; g < result->said.size(); ++g)
    if (result->said[g]) result->labels[g] = result->said[g] > 0;
}

}  // namespace splatcut
