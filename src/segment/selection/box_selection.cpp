// Boxes: what ClickSelection makes of them.
#include <algorithm>
#include <utility>

#include "segment/selection/box_by_colour.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

namespace {

using Leaves = std::vector<std::uint8_t>;

bool any(const Leaves& leaves) {
  return std::ranges::count(leaves, 1) > 0;
}

// What the trees agree on, else the likeliest single part.
Leaves what_fills(const PartHierarchy& parts, const BoxMeanings& meanings,
                  std::span<const PartMeaning> found) {
  Leaves agreed = meanings.agreed(vote_shares(parts, found));
  return any(agreed) ? agreed : leaves_of(parts, found.front().tree, found.front().node);
}

// What fills the box, what colour says of it beside that, or before it where that stands out clearly more,
// then the likeliest single parts: each looks clearly different from all before.
std::vector<Leaves> distinct_meanings(const PartHierarchy& parts, const LeafView& view,
                                      const Leaves& by_colour, const BoxPx& box, const BoxMeanings& meanings,
                                      const Leaves& fills, std::span<const PartMeaning> found,
                                      float offered) {
  std::vector<Leaves> meant;
  const auto add = [&](const Leaves& leaves) {
    const auto alike = [&](const Leaves& other) { return look_alike(view, other, leaves); };
    if (any(leaves) && std::ranges::none_of(meant, alike)) meant.push_back(leaves);
  };
  const bool colour_first = stands_out_more(meanings, view, box, by_colour, fills);
  add(colour_first ? by_colour : fills);
  add(colour_first ? fills : by_colour);
  for (const PartMeaning& meaning : found) {
    if (std::ssize(meant) == kMostMeanings || meaning.cost > found.front().cost + offered) break;
    add(leaves_of(parts, meaning.tree, meaning.node));
  }
  return meant;
}

}  // namespace

bool ClickSelection::take_box(const LeafView& view, const Stroke& stroke, const FirstStroke& first) {
  const bool object = stroke.label == SeedLabel::kObject;
  const BoxPx box = box_in_picture(stroke, view.camera.width_px, view.camera.height_px);
  const BoxMeanings meanings(parts_, view, box, model_.box);
  const std::vector<PartMeaning> found = meanings.all();
  if (found.empty()) return false;
  Leaves leaves = what_fills(parts_, meanings, found);
  if (!any_) {
    const Leaves by_colour =
        first.by_colour.empty() ? leaves_by_colour(parts_, view, stroke) : first.by_colour;
    const std::vector<Leaves> meant =
        distinct_meanings(parts_, view, by_colour, box, meanings, leaves, found, model_.offered);
    Offers offers;
    for (const Leaves& some : meant) offers.masks.push_back(shown(view.leaves, view.camera, some));
    offers_ = std::make_shared<const Offers>(std::move(offers));
    choice_taken_ = std::min(static_cast<std::size_t>(std::max(choice_, 0)), meant.size() - 1);
    selected_.meanings = std::make_shared<const std::vector<PartMeaning>>(found);
    selected_.boxed = true;
    leaves =
        note_sizes(view, part_sizes(parts_, meant[choice_taken_], found, view.leaf_px), stroke.size_step, {});
    note_certainty(view, leaves);
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
