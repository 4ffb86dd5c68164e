#include "segment/selection/settled_by_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "segment/masks/colour_overlap.h"
#include "segment/masks/refine_mask.h"

namespace splatcut {

namespace {

using TreesHeld = std::uint64_t;  // a bit for each voter, of the first 64: a group's name

struct Votes {
  std::vector<TreesHeld> held_by;  // per leaf
  std::vector<float> share;        // per leaf
  TreesHeld all = 0;               // of all voters
  bool undecided(std::size_t leaf) const { return held_by[leaf] != 0 && held_by[leaf] != all; }
};

float log_odds(float share) {
  return std::log(share / (1 - share));
}

// The likely meanings that look like what is taken, and more like it than like any other that is offered.
std::vector<PartMeaning> alike(const PartHierarchy& parts, const LeafView& view,
                               std::span<const PartMeaning> meanings, std::span<const std::uint8_t> taken,
                               std::span<const std::vector<std::uint8_t>> others) {
  constexpr float kAlike = 0.6f, kUnlikely = 6;  // ln 400: such a vote changes nothing
  std::vector<PartMeaning> found;
  for (const PartMeaning& meaning : meanings) {
    if (meaning.cost > meanings.front().cost + kUnlikely) break;
    const std::vector<std::uint8_t> held = leaves_of(parts, meaning.tree, meaning.node);
    const float likeness = iou(view.leaf_px, taken, held);
    const auto nearer = [&](const auto& other) { return iou(view.leaf_px, other, held) > likeness; };
    if (likeness >= kAlike && std::ranges::none_of(others, nearer)) found.push_back(meaning);
  }
  return found;
}

// meanings: those that look like what is taken.
Votes votes_of(const PartHierarchy& parts, std::span<const PartMeaning> meanings) {
  Votes votes{.held_by = std::vector<TreesHeld>(parts.leaves, 0), .share = vote_shares(parts, meanings)};
  if (votes.share.empty()) return votes;
  TreesHeld bit = 1;
  for (const PartMeaning& voter : voters(parts, meanings)) {
    const std::vector<std::uint8_t> held = leaves_of(parts, voter.tree, voter.node);
    for (std::uint32_t l = 0; l < parts.leaves; ++l) votes.held_by[l] |= held[l] ? bit : 0;
    votes.all |= bit;
    bit <<= 1;
  }
  return votes;
}

// Per colour, how much likelier it is in the object than around it: ln((p + e) / (q + e)). Around it: within
// half of its extent on each side.
std::array<float, kColourBins> colours_speak(const Image<std::uint16_t>& colour,
                                             const Image<std::uint32_t>& leaf, const Votes& votes) {
  constexpr float kAround = 0.5f, kEver = 1e-3f;
  const auto share = [&](int x, int y) { return leaf.at(x, y) == kNoPart ? 0 : votes.share[leaf.at(x, y)]; };
  BoxPx extent{{static_cast<float>(leaf.width()), static_cast<float>(leaf.height())}, {0, 0}};
  for (int y = 0; y < leaf.height(); ++y)
    for (int x = 0; x < leaf.width(); ++x) {
      if (share(x, y) <= 0) continue;
      extent.low_px = glm::min(extent.low_px, glm::vec2(x, y));
      extent.high_px = glm::max(extent.high_px, glm::vec2(x + 1, y + 1));
    }
  const glm::vec2 margin_px = kAround * extent.size_px();
  const BoxPx around{extent.low_px - margin_px, extent.high_px + margin_px};
  std::array<std::array<float, kColourBins>, 2> pixels{};
  std::array<float, 2> all{};
  for (int y = 0; y < leaf.height(); ++y)
    for (int x = 0; x < leaf.width(); ++x) {
      if (!around.contains(glm::vec2(x, y) + 0.5f)) continue;
      const float object = share(x, y);
      pixels[0][colour.at(x, y)] += 1 - object;
      pixels[1][colour.at(x, y)] += object;
      all[0] += 1 - object;
      all[1] += object;
    }
  std::array<float, kColourBins> ratio{};
  for (std::size_t bin = 0; bin < kColourBins; ++bin)
    ratio[bin] = std::log((pixels[1][bin] / std::max(all[1], 1.0f) + kEver) /
                          (pixels[0][bin] / std::max(all[0], 1.0f) + kEver));
  return ratio;
}

// Decides the groups of leaves that some voters hold and others do not. leaf: that each pixel shows.
void settle_groups(const Votes& votes, const Image<std::uint32_t>& leaf, const Image<float>& colour_odds,
                   std::vector<std::uint8_t>* settled) {
  constexpr float kLeastPx = 3, kLeastShare = 0.03f;
  struct Group {
    float odds = 0, px = 0;
  };
  std::map<TreesHeld, Group> groups;
  for (std::size_t pixel = 0; pixel < leaf.size(); ++pixel) {
    const std::uint32_t shown = leaf.pixels()[pixel];
    if (shown == kNoPart || !votes.undecided(shown)) continue;
    Group& group = groups[votes.held_by[shown]];
    group.odds += colour_odds.pixels()[pixel];
    ++group.px;
  }
  for (std::size_t l = 0; l < settled->size(); ++l) {
    if (!votes.undecided(l)) continue;
    const Group& group = groups[votes.held_by[l]];
    if (group.px < kLeastPx) continue;  // nothing of it is seen
    const float share = std::clamp(votes.share[l], kLeastShare, 1 - kLeastShare);
    (*settled)[l] = log_odds(share) + group.odds / group.px > 0;
  }
}

// True if the frame cuts the object off: most of the border would be the frame.
bool cropped(const Mask& object) {
  constexpr float kMostOnFrame = 0.05f;  // of the frame's pixels
  const auto on_frame = [&](int x, int y) { return object.at(x, y) == kMaskObject ? 1 : 0; };
  int on = 0;
  for (int x = 0; x < object.width(); ++x) on += on_frame(x, 0) + on_frame(x, object.height() - 1);
  for (int y = 0; y < object.height(); ++y) on += on_frame(0, y) + on_frame(object.width() - 1, y);
  return static_cast<float>(on) > kMostOnFrame * 2 * static_cast<float>(object.width() + object.height());
}

// Moves the border of the settled leaves to where the picture has an edge.
void settle_border(const LeafView& view, const Votes& votes, const Image<std::uint32_t>& leaf,
                   const Image<float>& colour_odds, std::vector<std::uint8_t>* settled) {
  constexpr float kLeastPx = 3, kLeastShare = 0.1f, kMostOdds = 3;
  const RefineOptions edges{.band_px = 24, .lambda = 12};
  Mask prior(leaf.width(), leaf.height());
  Image<float> odds(leaf.width(), leaf.height(), -kMostOdds);
  for (std::size_t pixel = 0; pixel < leaf.size(); ++pixel) {
    const std::uint32_t shown = leaf.pixels()[pixel];
    if (shown == kNoPart) continue;
    if ((*settled)[shown]) prior.pixels()[pixel] = kMaskObject;
    const float share = votes.undecided(shown) ? (*settled)[shown] : votes.share[shown];
    odds.pixels()[pixel] = log_odds(std::clamp(share, kLeastShare, 1 - kLeastShare)) +
                           std::clamp(colour_odds.pixels()[pixel], -kMostOdds, kMostOdds);
  }
  if (cropped(prior)) return;
  const Mask object = cut_by_odds(view.colour, view.depth, prior, odds, edges);
  std::vector<float> inside(settled->size(), 0), all(settled->size(), 0);
  for (std::size_t pixel = 0; pixel < leaf.size(); ++pixel) {
    const std::uint32_t shown = leaf.pixels()[pixel];
    if (shown == kNoPart) continue;
    inside[shown] += object.pixels()[pixel] != 0;
    all[shown] += 1;
  }
  for (std::size_t l = 0; l < settled->size(); ++l)
    if (all[l] >= kLeastPx && 2 * inside[l] != all[l]) (*settled)[l] = 2 * inside[l] > all[l];
}

}  // namespace

std::vector<std::uint8_t> settled_by_colour(const PartHierarchy& parts, const LeafView& view,
                                            std::span<const PartMeaning> meanings,
                                            std::span<const std::uint8_t> taken,
                                            std::span<const std::vector<std::uint8_t>> others) {
  std::vector<std::uint8_t> settled(taken.begin(), taken.end());
  if (view.colour.empty() || meanings.empty()) return settled;
  const Votes votes = votes_of(parts, alike(parts, view, meanings, taken, others));
  if (votes.share.empty()) return settled;
  const Image<std::uint16_t> counted =
      view.colour_bins.empty() ? colour_bins(view.colour) : Image<std::uint16_t>();
  const Image<std::uint16_t>& colour = view.colour_bins.empty() ? counted : view.colour_bins;
  const Image<std::uint32_t>& leaf = view.leaf;
  const std::array<float, kColourBins> ratio = colours_speak(colour, leaf, votes);
  Image<float> colour_odds(leaf.width(), leaf.height());
  std::ranges::transform(colour.pixels(), colour_odds.pixels().begin(), [&](auto bin) { return ratio[bin]; });
  settle_groups(votes, leaf, colour_odds, &settled);
  settle_border(view, votes, leaf, colour_odds, &settled);
  return settled;
}

}  // namespace splatcut
