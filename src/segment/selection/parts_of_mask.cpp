#include <algorithm>
#include <utility>

#include "segment/selection/part_terms.h"
#include "segment/superpoints/part_view.h"

namespace splatcut {

namespace {

std::vector<float> inside_pixels(const PartHierarchy& parts, const PartView& view, const Mask& mask) {
  std::vector<float> inside(parts.leaves, 0);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (const std::uint32_t leaf = view.leaf.pixels()[i]; leaf != kNoPart && mask.pixels()[i])
      inside[leaf] += 1;
  return inside;
}

// Per node: 1 where it or an ancestor is chosen whole.
std::vector<std::uint8_t> chosen_nodes(const PartTree& tree, std::size_t leaves,
                                       const std::vector<float>& pixels,
                                       const std::vector<float>& inside_of_leaves,
                                       const MaskToPartsOptions& options) {
  const std::vector<float> inside = summed(tree, inside_of_leaves);
  std::vector<float> shown_area(leaves, 0);
  for (std::size_t leaf = 0; leaf < leaves; ++leaf) shown_area[leaf] = pixels[leaf] > 0 ? tree.area[leaf] : 0;
  shown_area = summed(tree, std::move(shown_area));
  std::vector<float> best(tree.nodes(), 0);  // most pixels right minus wrong
  std::vector<std::uint8_t> whole(tree.nodes(), 0);
  for (std::size_t node = 0; node < tree.nodes(); ++node) {
    const auto [a, b] = tree.children[node];
    const float apart = a == kNoPart ? 0 : best[a] + best[b];
    const float together = 2 * inside[node] - pixels[node];
    whole[node] = together > 0 && together >= apart - options.tolerance * pixels[node] &&
                  shown_area[node] >= options.least_visible * tree.area[node];
    best[node] = whole[node] ? std::max(together, apart) : apart;
  }
  return below(tree, std::move(whole));
}

}  // namespace

std::vector<std::uint8_t> parts_of_mask(const PartHierarchy& parts, const PartView& view, const Mask& mask,
                                        const MaskToPartsOptions& options) {
  const std::vector<float> inside = inside_pixels(parts, view, mask);
  std::vector<std::size_t> votes(parts.leaves, 0);
  for (std::size_t t = 0; t < parts.trees.size(); ++t) {
    const auto chosen = chosen_nodes(parts.trees[t], parts.leaves, view.trees[t].pixels, inside, options);
    for (std::uint32_t leaf = 0; leaf < parts.leaves; ++leaf) votes[leaf] += chosen[leaf];
  }
  std::vector<std::uint8_t> leaves(parts.leaves);
  std::ranges::transform(votes, leaves.begin(), [&](std::size_t v) {
    return static_cast<std::uint8_t>(2 * v > parts.trees.size());
  });
  return leaves;
}

}  // namespace splatcut
