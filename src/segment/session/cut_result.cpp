#include "segment/session/cut_result.h"

#include <algorithm>

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

void keep_object(CutResult* result) {
  const auto object = [](const std::vector<std::uint8_t>& labels) { return std::ranges::count(labels, 1); };
  if (!result->prior.empty() && 2 * object(result->labels) < object(result->prior))
    result->labels = result->prior;
}

void obey_strokes(CutResult* result) {
  for (std::size_t g = 0; g < result->said.size(); ++g)
    if (result->said[g]) result->labels[g] = result->said[g] > 0;
}

}  // namespace splatcut
