#include "segment/selection/first_meanings.h"

#include <algorithm>

namespace splatcut {

float certainty_of(const PartHierarchy& parts, std::span<const PartMeaning> meanings,
                   std::span<const std::uint8_t> set, std::span<const float> leaf_px, bool boxed) {
  constexpr float kUnlikely = 0.0025f;
  float sum = 0, all = 0;
  const auto count = [&](const PartMeaning& meaning) {
    const float likely = vote_of(meaning, meanings);
    if (likely < kUnlikely) return;
    sum += likely * iou(leaf_px, set, leaves_of(parts, meaning.tree, meaning.node));
    all += likely;
  };
  std::ranges::for_each(boxed ? voters(parts, meanings) : std::vector(meanings.begin(), meanings.end()),
                        count);
  return sum / all;
}

std::vector<PartMeaning> meanings_left(const PartHierarchy& parts, const SelectedParts& selected,
                                       std::uint32_t leaf, bool object) {
  std::vector<PartMeaning> left;
  for (const PartMeaning& meaning : *selected.meanings) {
    const PartTree& tree = parts.trees[meaning.tree];
    const auto inside = [&](std::uint32_t node) {
      while (node < meaning.node) node = tree.parent[node];  // parents come after their children
      return node == meaning.node;
    };
    if (inside(leaf) == object && std::ranges::all_of(selected.clicked[1], inside) &&
        std::ranges::none_of(selected.clicked[0], inside))
      left.push_back(meaning);
  }
  return left;
}

AgreedMeaning agreed_meaning(const PartHierarchy& parts, std::span<const PartMeaning> meanings,
                             std::span<const float> leaf_px) {
  const std::vector<float> shares = vote_shares(parts, meanings);
  AgreedMeaning agreed{.leaves = majority(shares)};
  float doubted_px = 0, agreed_px = 0;
  for (std::size_t leaf = 0; leaf < shares.size(); ++leaf) {
    doubted_px += leaf_px[leaf] * std::min(shares[leaf], 1 - shares[leaf]);
    if (agreed.leaves[leaf]) agreed_px += leaf_px[leaf];
  }
  agreed.doubt = doubted_px / std::max(agreed_px, 1.0f);
  return agreed;
}

}  // namespace splatcut
