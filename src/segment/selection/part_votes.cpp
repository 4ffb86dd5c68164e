#include "segment/selection/part_votes.h"

#include <algorithm>
#include <utility>

#include "segment/selection/part_terms.h"

namespace splatcut {

std::vector<std::uint8_t> leaves_of(const PartHierarchy& parts, std::uint32_t tree, std::uint32_t node) {
  std::vector<std::uint8_t> marked(parts.trees[tree].nodes(), 0);
  marked[node] = 1;
  std::vector<std::uint8_t> leaves = below(parts.trees[tree], std::move(marked));
  leaves.resize(parts.leaves);
  return leaves;
}

std::vector<PartMeaning> voters(const PartHierarchy& parts, std::span<const PartMeaning> meanings) {
  std::vector<PartMeaning> best_of_each;
  for (std::uint32_t t = 0; t < parts.trees.size(); ++t) {
    const auto best = std::ranges::find(meanings, t, &PartMeaning::tree);
    if (best != meanings.end()) best_of_each.push_back(*best);
  }
  return best_of_each;
}

std::vector<float> vote_shares(const PartHierarchy& parts, std::span<const PartMeaning> meanings) {
  if (meanings.empty()) return {};
  std::vector<float> shares(parts.leaves, 0);
  float votes = 0;
  for (const PartMeaning& voter : voters(parts, meanings)) {
    const float vote = vote_of(voter, meanings);
    const std::vector<std::uint8_t> leaves = leaves_of(parts, voter.tree, voter.node);
    for (std::uint32_t l = 0; l < parts.leaves; ++l) shares[l] += leaves[l] ? vote : 0;
    votes += vote;
  }
  for (float& share : shares) share /= votes;
  return shares;
}

std::vector<std::uint8_t> majority(std::span<const float> shares) {
  std::vector<std::uint8_t> leaves(shares.size());
  std::ranges::transform(shares, leaves.begin(), [](float s) { return s > 0.5f ? 1 : 0; });
  return leaves;
}

}  // namespace splatcut
