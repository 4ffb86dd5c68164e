#include "segment/superpoints/part_view.h"

namespace splatcut {

PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit) {
  PartView view{Image<std::uint32_t>(first_hit.width(), first_hit.height(), kNoPart), {}};
  PartView::Tree leaves{std::vector<float>(parts.leaves, 0)};
  for (int y = 0; y < first_hit.height(); ++y)
    for (int x = 0; x < first_hit.width(); ++x) {
      if (first_hit.at(x, y) < 0) continue;
      const std::uint32_t leaf = parts.leaf_of[static_cast<std::size_t>(first_hit.at(x, y))];
      view.leaf.at(x, y) = leaf;
      if (leaf != kNoPart) leaves.pixels[leaf] += 1;
    }
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
