#include "segment/robot_user.h"

#include <algorithm>

#include "segment/mask_tools.h"

namespace splatcut {

std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask) {
  Mask missing(truth.width(), truth.height()), extra(truth.width(), truth.height());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool is = truth.pixels()[i], said = mask.pixels()[i];
    missing.pixels()[i] = is && !said ? kMaskObject : 0;
    extra.pixels()[i] = !is && said ? kMaskObject : 0;
  }
  const Mask most_missing = largest_region(missing), most_extra = largest_region(extra);
  const bool positive = count(most_missing) >= count(most_extra);
  const Mask& region = positive ? most_missing : most_extra;
  if (count(region) == 0) return std::nullopt;
  const Image<float> depth = distance_inside(region);
  const auto deepest = std::ranges::max_element(depth.pixels()) - depth.pixels().begin();
  const glm::vec2 pixel(static_cast<float>(deepest % region.width()) + 0.5f, static_cast<float>(deepest / region.width()) + 0.5f);
  return click(pixel, positive ? SeedLabel::kObject : SeedLabel::kRest);
}

}  // namespace splatcut
