// Sizes: what ClickSelection makes of a stroke's step to another one.
#include <algorithm>
#include <utility>

#include "segment/selection/click_selection.h"
#include "segment/selection/first_meanings.h"

namespace splatcut {

namespace {

// Ratios of pixels of a correction, which is mostly small: from which, and up to which, a part is the next
// size; from which the spot is a size of its own.
constexpr float kNextFolds = 1.5f, kFarFolds = 2, kSpotFolds = 1.2f;

}  // namespace

std::span<const Mask> ClickSelection::size_masks() const {
  return sizes_.masks ? std::span<const Mask>(*sizes_.masks) : std::span<const Mask>();
}

// Notes the meanings and the sizes of the one that is chosen. Returns the leaves of the size that is taken.
std::vector<std::uint8_t> ClickSelection::first_leaves(const LeafView& view, const Answers& found,
                                                       int size_step) {
  std::vector<PartMeaning> all;
  const auto add = [&](std::span<const Candidate> some) {
    for (const Candidate& c : some)
      all.push_back({static_cast<std::uint32_t>(c.chain), found.chains[c.chain].nodes[c.index], {}, c.cost});
  };
  add(found.candidates);
  selected_.meanings = std::make_shared<const std::vector<PartMeaning>>(all);
  add(found.unlikely);
  std::ranges::stable_sort(all, {}, &PartMeaning::cost);
  note_offers(view, found, all);
  choice_taken_ = std::min(static_cast<std::size_t>(std::max(choice_, 0)), offers_->meant.size() - 1);
  std::vector<std::uint8_t> taken =
      note_sizes(view, part_sizes(parts_, offers_->meant[choice_taken_], all, view.leaf_px), size_step, {});
  note_certainty(view, taken);
  return taken;
}

void ClickSelection::note_certainty(const LeafView& view, const std::vector<std::uint8_t>& taken) {
  const bool chosen = choice_taken_ > 0 || sizes_.size != sizes_.likeliest;
  certainty_ = chosen ? 1 : certainty_of(parts_, *selected_.meanings, taken, view.leaf_px, selected_.boxed);
}

// Notes which sizes there are. Returns the leaves of the one that is that many steps from the one taken.
std::vector<std::uint8_t> ClickSelection::note_sizes(const LeafView& view, const PartSizes& sizes, int step,
                                                     const CorrectedPixels& pixels) {
  const auto wanted = static_cast<std::ptrdiff_t>(sizes.taken) + step;
  const auto size = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(wanted, 0, static_cast<std::ptrdiff_t>(sizes.count) - 1));
  std::vector<Mask> masks;
  for (std::size_t i = 0; i < sizes.count; ++i) {
    masks.push_back(shown(view.leaves, view.camera, sizes.leaves(i)));
    for (const std::uint32_t pixel : pixels.spot) masks.back().pixels()[pixel] = kMaskObject;
    if (i < sizes.taken) continue;
    for (const std::uint32_t pixel : pixels.by_colour) masks.back().pixels()[pixel] = kMaskObject;
  }
  sizes_ = {sizes.count, size, sizes.taken, std::make_shared<const std::vector<Mask>>(std::move(masks))};
  return sizes.leaves(size);
}

void ClickSelection::crop_sizes(const PixelRect& part) {
  if (!sizes_.masks) return;
  std::vector<Mask> masks;
  for (const Mask& mask : *sizes_.masks) {
    Mask& cropped = masks.emplace_back(part.width(), part.height());
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) cropped.at(x, y) = mask.at(part.x0 + x, part.y0 + y);
  }
  sizes_.masks = std::make_shared<const std::vector<Mask>>(std::move(masks));
}

// Notes the sizes of what a correction changes. meant: what it changes by itself. The smallest size is the
// spot alone.
std::vector<std::uint8_t> ClickSelection::corrected_leaves(const Click& click, const Answers& found,
                                                           const std::vector<std::uint8_t>& meant,
                                                           const CorrectedPixels& pixels, int size_step) {
  const LeafView& view = click.view;
  const auto changes = [&](std::uint32_t l) {
    return meant[l] || (found.free[l] && (selected_.object[l] != 0) != click.object);
  };
  std::vector<float> changed_px(parts_.leaves, 0);
  for (std::uint32_t l = 0; l < parts_.leaves; ++l)
    if (changes(l)) changed_px[l] = view.leaf_px[l];
  std::vector<PartMeaning> all;
  for (const std::vector<Candidate>* some : {&found.candidates, &found.unlikely})
    for (const Candidate& c : *some)
      if (c.index != Candidate::kDiscAlone && found.chains[c.chain].of_tree)
        all.push_back(
            {static_cast<std::uint32_t>(c.chain), found.chains[c.chain].nodes[c.index], {}, c.cost});
  const float spot_px = std::max(static_cast<float>(pixels.spot.size()), kLeastSizePx);
  PartSizes sizes =
      part_sizes(parts_, meant, all, changed_px, {.least_px = spot_px, .next = kNextFolds, .far = kFarFolds});
  const auto leaves_something = [&](std::size_t size) {
    for (std::uint32_t l = 0; l < parts_.leaves; ++l)
      if (selected_.object[l] && (!changes(l) || sizes.level[l] > size)) return true;
    return false;
  };
  while (!click.object && sizes.count > sizes.taken + 1 && !leaves_something(sizes.count - 1)) {
    --sizes.count;
    for (std::uint32_t& level : sizes.level)
      if (level == sizes.count) level = kNoLevel;
  }
  float smallest_px = 0;
  for (std::uint32_t l = 0; l < parts_.leaves; ++l) {
    if (!changes(l)) sizes.level[l] = kNoLevel;
    if (sizes.level[l] == 0) smallest_px += changed_px[l];
  }
  if (sizes.taken == 0) smallest_px = std::max(smallest_px, static_cast<float>(pixels.by_colour.size()));
  if (smallest_px >= kSpotFolds * spot_px) {
    ++sizes.count;
    ++sizes.taken;
    for (std::uint32_t& level : sizes.level)
      if (level != kNoLevel) ++level;
  }
  return note_sizes(view, sizes, size_step, pixels);
}

}  // namespace splatcut
