#include "segment/selection/part_sizes.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "segment/selection/leaf_view.h"
#include "segment/selection/part_terms.h"

namespace splatcut {

namespace {

constexpr float kSameSize = 1.25f;  // ratio of parts among which the cheapest is taken if all are too far
constexpr float kInside = 0.9f;     // share of the smaller set's pixels that the larger one holds
constexpr std::size_t kMostSizes = 64;

using LeafFlags = std::vector<std::uint8_t>;

struct NextSize {
  const PartMeaning* part;
  float folds;  // ratio of its pixels and those of the size before, at least 1
};

class Ladder {
 public:
  Ladder(const PartHierarchy& parts, std::span<const PartMeaning> meanings, std::span<const float> leaf_px,
         const SizeSteps& steps)
      : parts_(parts),
        meanings_(meanings),
        leaf_px_(leaf_px),
        steps_(steps),
        px_(pixels_of(LeafFlags(parts.leaves, 1))) {}

  // Sizes beyond the set, from one to the next.
  std::vector<LeafFlags> from(const LeafFlags& set, bool larger) const {
    std::vector<LeafFlags> sizes;
    while (sizes.size() < kMostSizes) {
      std::optional<LeafFlags> next = step(sizes.empty() ? set : sizes.back(), larger);
      if (!next) break;
      sizes.push_back(std::move(*next));
    }
    return sizes;
  }

 private:
  // Pixels that each meaning shares with the set.
  std::vector<float> pixels_of(const LeafFlags& set) const {
    std::vector<float> own(parts_.leaves);
    for (std::size_t l = 0; l < own.size(); ++l) own[l] = set[l] ? leaf_px_[l] : 0;
    std::vector<std::vector<float>> of_tree;
    for (const PartTree& tree : parts_.trees) of_tree.push_back(summed(tree, own));
    std::vector<float> px;
    for (const PartMeaning& m : meanings_) px.push_back(of_tree[m.tree][m.node]);
    return px;
  }

  std::optional<LeafFlags> step(const LeafFlags& set, bool larger) const {
    float set_px = 0;
    for (std::size_t l = 0; l < set.size(); ++l) set_px += set[l] ? leaf_px_[l] : 0;
    const std::vector<float> common = pixels_of(set);
    std::vector<NextSize> fit;
    for (std::size_t m = 0; m < meanings_.size(); ++m) {
      const float px = std::max(px_[m], steps_.least_px), before_px = std::max(set_px, steps_.least_px);
      const float folds = larger ? px / before_px : before_px / px;
      if (px_[m] >= steps_.least_px && folds >= steps_.next && common[m] >= kInside * std::min(px, set_px))
        fit.push_back({&meanings_[m], folds});
    }
    if (fit.empty()) return std::nullopt;
    const float nearest = std::ranges::min(fit, {}, &NextSize::folds).folds;
    const float farthest = std::max(steps_.far, kSameSize * nearest);
    std::erase_if(fit, [&](const NextSize& size) { return size.folds > farthest; });
    const auto best = std::ranges::min_element(fit, {}, [](const NextSize& size) { return size.part->cost; });
    LeafFlags next = leaves_of(parts_, best->part->tree, best->part->node);
    for (std::size_t l = 0; l < next.size(); ++l) next[l] = larger ? next[l] | set[l] : next[l] & set[l];
    return next;
  }

  const PartHierarchy& parts_;
  std::span<const PartMeaning> meanings_;
  std::span<const float> leaf_px_;
  SizeSteps steps_;
  std::vector<float> px_;  // pixels per meaning
};

}  // namespace

std::vector<std::uint8_t> PartSizes::leaves(std::size_t size) const {
  LeafFlags flags(level.size());
  std::ranges::transform(level, flags.begin(), [&](std::uint32_t l) { return l <= size; });
  return flags;
}

PartSizes part_sizes(const PartHierarchy& parts, std::span<const std::uint8_t> taken,
                     std::span<const PartMeaning> meanings, std::span<const float> leaf_px,
                     const SizeSteps& steps) {
  const Ladder ladder(parts, meanings, leaf_px, steps);
  const LeafFlags set(taken.begin(), taken.end());
  std::vector<LeafFlags> sizes = ladder.from(set, false);
  std::ranges::reverse(sizes);
  PartSizes found{.level = std::vector<std::uint32_t>(parts.leaves, kNoLevel), .taken = sizes.size()};
  sizes.push_back(set);
  for (LeafFlags& larger : ladder.from(set, true)) sizes.push_back(std::move(larger));
  found.count = sizes.size();
  for (std::size_t s = sizes.size(); s-- > 0;)
    for (std::size_t l = 0; l < parts.leaves; ++l)
      if (sizes[s][l]) found.level[l] = static_cast<std::uint32_t>(s);
  return found;
}

}  // namespace splatcut
