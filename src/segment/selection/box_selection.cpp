// Boxes: what ClickSelection makes of them.
#include <algorithm>
#include <utility>

#include "segment/selection/box_meanings.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

namespace {

using Leaves = std::vector<std::uint8_t>;

// What the trees agree on, then the likeliest single parts that look clearly different from all before.
std::vector<Leaves> distinct_meanings(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                                      std::span<const PartMeaning> found, const TermValues& weights,
                                      float offered) {
  std::vector<Leaves> meant;
  const std::vector<float> shares = vote_shares(parts, found);
  if (Leaves agreed = agreed_in_box(parts, view, box, shares, weights); std::ranges::count(agreed, 1) > 0)
    meant.push_back(std::move(agreed));
  for (const PartMeaning& meaning : found) {
    if (std::ssize(meant) == kMostMeanings || meaning.cost > found.front().cost + offered) break;
    Leaves leaves = leaves_of(parts, meaning.tree, meaning.node);
    const auto alike = [&](const Leaves& other) { return look_alike(view, other, leaves); };
    if (std::ranges::none_of(meant, alike)) meant.push_back(std::move(leaves));
  }
  return meant;
}

}  // namespace

bool ClickSelection::take_box(const LeafView& view, const Stroke& stroke) {
  const bool object = stroke.label == SeedLabel::kObject;
  const BoxPx box = box_in_picture(stroke, view.camera.width_px, view.camera.height_px);
  const std::vector<PartMeaning> found = box_meanings(parts_, view, box, model_.box);
  if (found.empty()) return false;
  const std::vector<Leaves> meant =
      distinct_meanings(parts_, view, box, found, model_.box, any_ ? 0 : model_.offered);
  Leaves leaves = meant.front();
  if (!any_) {
    Offers offers;
    for (const Leaves& some : meant) offers.masks.push_back(shown(view.leaves, view.camera, some));
    offers_ = std::make_shared<const Offers>(std::move(offers));
    choice_taken_ = std::min(static_cast<std::size_t>(std::max(choice_, 0)), meant.size() - 1);
    leaves = note_sizes(view, part_sizes(parts_, meant[choice_taken_], found, view.leaf_px));
  }
  Change change{.leaves = {}, .object = object};
  for (std::uint32_t l = 0; l < parts_.leaves; ++l) {
    if (!leaves[l] || (selected_.object[l] != 0) == object || selected_.said[l] == (object ? -1 : 1))
      continue;
    selected_.object[l] = object;
    change.leaves.push_back(l);
  }
  if (any_) selected_.changes.push_back(std::move(change));
  any_ = true;
  spot_alone_ = false;
  label();
  return true;
}

}  // namespace splatcut
