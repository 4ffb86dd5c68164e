#include "segment/selection/part_votes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "segment/selection/part_terms.h"

namespace splatcut {

namespace {

// Per node, how many of the leaves it holds.
std::vector<float> held_by_nodes(const PartHierarchy& parts, const PartTree& tree,
                                 std::span<const std::uint32_t> leaves) {
  std::vector<float> count(parts.leaves, 0);
  for (const std::uint32_t leaf : leaves) count[leaf] += 1;
  return summed(tree, std::move(count));
}

}  // namespace

std::vector<std::uint8_t> leaves_of(const PartHierarchy& parts, std::uint32_t tree, std::uint32_t node) {
  std::vector<std::uint8_t> marked(parts.trees[tree].nodes(), 0);
  marked[node] = 1;
  std::vector<std::uint8_t> leaves = below(parts.trees[tree], std::move(marked));
  leaves.resize(parts.leaves);
  return leaves;
}

std::vector<float> vote_shares(const PartHierarchy& parts, std::span<const PartMeaning> meanings,
                               std::span<const std::uint32_t> held, std::span<const std::uint32_t> left_out) {
  std::vector<PartMeaning> voters;
  for (std::uint32_t t = 0; t < parts.trees.size(); ++t) {
    const std::vector<float> wanted = held_by_nodes(parts, parts.trees[t], held),
                             unwanted = held_by_nodes(parts, parts.trees[t], left_out);
    const auto fits = [&](const PartMeaning& m) {
      return m.tree == t && wanted[m.node] == static_cast<float>(held.size()) && unwanted[m.node] == 0;
    };
    const auto best = std::ranges::find_if(meanings, fits);
    if (best != meanings.end()) voters.push_back(*best);
  }
  if (voters.empty()) return {};
  const float least = std::ranges::min(voters, {}, &PartMeaning::cost).cost;
  std::vector<float> shares(parts.leaves, 0);
  float votes = 0;
  for (const PartMeaning& voter : voters) {
    const float vote = std::exp(least - voter.cost);
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
