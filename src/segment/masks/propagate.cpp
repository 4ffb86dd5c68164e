#include "segment/masks/propagate.h"

#include <algorithm>

namespace splatcut {

std::vector<Propagator> propagators() {
  return {
#define SPLATCUT_LIST_ROW(row) Propagator::row,
      SPLATCUT_PROPAGATORS(SPLATCUT_LIST_ROW)
#undef SPLATCUT_LIST_ROW
  };
}

const SeenView& nearest(const OpenView& view) {
  return *std::ranges::min_element(view.seen, {}, [&](const SeenView& v) {
    return glm::distance(v.camera.centre_world(), view.camera.centre_world());
  });
}

}  // namespace splatcut
