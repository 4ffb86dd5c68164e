#include "segment/selection/reached_leaves.h"

#include "segment/masks/colour_overlap.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

template <class Holds>
Mask mask_where(const Mask& like, Holds holds) {
  Mask out(like.width(), like.height());
  for (std::size_t i = 0; i < out.size(); ++i) out.pixels()[i] = holds(i) ? kMaskObject : 0;
  return out;
}

}  // namespace

std::vector<std::uint8_t> within_reach(const Click& click, std::span<const std::uint8_t> object,
                                       std::vector<std::uint8_t> leaves) {
  constexpr int kHalfGapPx = 2;
  constexpr float kOtherLook = -0.5f;
  const LeafView& view = click.view;
  if (click.object || view.colour.empty()) return leaves;
  std::vector<std::uint8_t> goes = leaves;
  for (std::size_t l = 0; l < goes.size(); ++l) goes[l] = goes[l] && object[l];
  const Mask all = shown(view.leaves, view.camera, goes);
  const Mask reached = connected_to(dilated(all, kHalfGapPx), click.at);
  const Mask near = mask_where(all, [&](auto i) { return all.pixels()[i] && reached.pixels()[i]; });
  const Mask apart = mask_where(all, [&](auto i) { return all.pixels()[i] && !reached.pixels()[i]; });
  const Mask stays = mask_where(all, [&](auto i) { return click.displayed.pixels()[i] && !all.pixels()[i]; });
  if (count(apart) == 0) return leaves;
  if (count(near) > 0 && log_ratio_of_colours(view.colour, apart, near, stays) > kOtherLook) return leaves;
  std::vector<float> reached_px(goes.size(), 0);
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const GroupWeight& w : view.leaves.at(i)) reached_px[w.group] += reached.pixels()[i] ? w.weight : 0;
  for (std::size_t l = 0; l < goes.size(); ++l)
    if (goes[l] && view.leaf_px[l] >= 1 && 2 * reached_px[l] < view.leaf_px[l]) leaves[l] = 0;
  return leaves;
}

}  // namespace splatcut
