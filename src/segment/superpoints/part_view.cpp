#include "segment/superpoints/part_view.h"

#include <utility>

namespace splatcut {

PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit) {
  Image<std::uint32_t> leaf(first_hit.width(), first_hit.height(), kNoPart);
  for (std::size_t i = 0; i < leaf.size(); ++i)
    if (const std::int32_t hit = first_hit.pixels()[i]; hit >= 0)
      leaf.pixels()[i] = parts.leaf_of[static_cast<std::size_t>(hit)];
  return view_parts(parts, std::move(leaf));
}

PartView view_parts(const PartHierarchy& parts, Image<std::uint32_t> leaf) {
  PartView view{std::move(leaf), {}};
  PartView::Tree leaves{std::vector<float>(parts.leaves, 0)};
  for (const std::uint32_t shown : view.leaf.pixels())
    if (shown != kNoPart) leaves.pixels[shown] += 1;
  for (const PartTree& tree : parts.trees) {
    PartView::Tree& of = view.trees.emplace_back(leaves);
    of.pixels.resize(tree.nodes(), 0);
    for (std::size_t node = 0; node < tree.nodes(); ++node)
      if (const std::uint32_t up = tree.parent[node]; up != kNoPart)  // children come before their parents
        of.pixels[up] += of.pixels[node];
  }
  return view;
}

std::vector<std::uint8_t> labels_of(const PartHierarchy& parts, const std::vector<std::uint8_t>& leaves) {
  std::vector<std::uint8_t> labels(parts.leaf_of.size(), 0);
  for (std::size_t g = 0; g < labels.size(); ++g)
    labels[g] = parts.leaf_of[g] != kNoPart && leaves[parts.leaf_of[g]];
  return labels;
}

Mask mask_of(const PartView& view, const std::vector<std::uint8_t>& leaves) {
  Mask mask(view.leaf.width(), view.leaf.height());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::uint32_t leaf = view.leaf.pixels()[i];
    mask.pixels()[i] = leaf != kNoPart && leaves[leaf] ? kMaskObject : 0;
  }
  return mask;
}

}  // namespace splatcut
