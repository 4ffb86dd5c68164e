#include "segment/superpoints/part_looks.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/parallel.h"
#include "scene/raster/depth_jump.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

namespace {

// Where two leaves meet in the picture; b may be kNoPart.
struct Meeting {
  std::uint32_t a = kNoPart, b = kNoPart;  // a < b
  int pairs = 0, plain = 0;                // of neighbouring pixels; where the depth does not jump
};

// One entry per two leaves, ascending.
std::vector<Meeting> merged(std::vector<Meeting> pairs) {
  std::ranges::sort(pairs, {}, [](const Meeting& m) { return std::tie(m.a, m.b); });
  std::vector<Meeting> sums;
  for (const Meeting& m : pairs) {
    if (sums.empty() || sums.back().a != m.a || sums.back().b != m.b) sums.push_back({m.a, m.b});
    sums.back().pairs += m.pairs;
    sums.back().plain += m.plain;
  }
  return sums;
}

std::vector<Meeting> meetings(const LeafPicture& picture) {
  const Image<std::uint32_t>& leaf = picture.leaf;
  std::vector<Meeting> pairs;
  const auto add = [&](const glm::ivec2& p, const glm::ivec2& step) {
    const glm::ivec2 q = p + step;
    if (!leaf.contains(q.x, q.y) || leaf.at(p.x, p.y) == leaf.at(q.x, q.y)) return;
    const auto [a, b] = std::minmax(leaf.at(p.x, p.y), leaf.at(q.x, q.y));
    // One pixel further on both sides: the border itself blends.
    pairs.push_back({a, b, 1, !depth_jumps(picture.depth, p - step, q + step, kJumpAtBorderOfPart)});
  };
  for (int y = 0; y < leaf.height(); ++y)
    for (int x = 0; x < leaf.width(); ++x) {
      add({x, y}, {1, 0});
      add({x, y}, {0, 1});
    }
  return merged(std::move(pairs));
}

// The lowest node that holds both, kNoPart for none. Parents come after their children.
std::uint32_t common(const PartTree& tree, std::uint32_t a, std::uint32_t b) {
  while (a != b) {
    std::uint32_t& lower = a < b ? a : b;
    lower = tree.parent[lower];
  }
  return a;
}

// In pixels.
void add_meeting(const PartTree& tree, const Meeting& m, std::vector<PartLooks>* looks) {
  const auto add = [&](std::uint32_t node, int times) {
    if (node == kNoPart) return;
    (*looks)[node].border += static_cast<float>(times * m.pairs);
    (*looks)[node].plain_border += static_cast<float>(times * m.plain);
  };
  add(m.a, 1);
  add(m.b, 1);
  // From the common node on the border lies inside; sums of children add both sides up.
  if (m.b != kNoPart) add(common(tree, m.a, m.b), -2);
}

// From pixels, whole numbers whose sums and differences are exact, to the picture's units.
void scale(float all_px, PartLooks* looks) {
  PartLooks& of = *looks;
  const float pixel = 1 / std::sqrt(all_px);
  of.area /= all_px;
  of.area_squared = of.area * of.area;
  of.side = std::sqrt(of.area);
  of.cropped_side = of.frame > 0 ? of.side : 0;
  of.frame *= pixel;
  of.border *= pixel;
  of.plain_border *= pixel;
}

}  // namespace

PartLooks& PartLooks::operator+=(const PartLooks& other) {
  area += other.area;
  area_squared += other.area_squared;
  side += other.side;
  cropped_side += other.cropped_side;
  frame += other.frame;
  border += other.border;
  plain_border += other.plain_border;
  return *this;
}

std::vector<std::vector<PartLooks>> looks_in(const PartHierarchy& parts, const LeafPicture& picture) {
  const Image<std::uint32_t>& leaf = picture.leaf;
  std::vector<PartLooks> of_leaves(parts.leaves);
  for (int y = 0; y < leaf.height(); ++y)
    for (int x = 0; x < leaf.width(); ++x) {
      if (leaf.at(x, y) == kNoPart) continue;
      PartLooks& of = of_leaves[leaf.at(x, y)];
      of.area += 1;
      if (x == 0 || y == 0 || x == leaf.width() - 1 || y == leaf.height() - 1) of.frame += 1;
    }
  const std::vector<Meeting> met = meetings(picture);
  std::vector<std::vector<PartLooks>> looks(parts.trees.size());
  for_each_index(looks.size(), [&](std::size_t t) {
    const PartTree& tree = parts.trees[t];
    looks[t] = of_leaves;
    looks[t].resize(tree.nodes());
    for (const Meeting& m : met) add_meeting(tree, m, &looks[t]);
    for (std::size_t node = 0; node < tree.nodes(); ++node) {  // children come before their parents
      const PartLooks& of = looks[t][node];
      if (of.area > 0 && tree.parent[node] != kNoPart) looks[t][tree.parent[node]] += of;
    }
    for (PartLooks& of : looks[t])
      if (of.area > 0) scale(static_cast<float>(leaf.size()), &of);  // most are not in the picture
  });
  return looks;
}

void look_at_parts(const Drawer& drawer, std::span<const Camera> views, PartHierarchy* parts,
                   const Job& job) {
  static_assert(kNoPart == kNoGroup);
  RasterOptions raster;
  raster.colour = false;
  raster.depth = true;
  raster.groups = parts->leaf_of;
  for (PartTree& tree : parts->trees) tree.looks.assign(tree.nodes(), {});
  for (const Camera& camera : views) {
    if (job.cancelled()) return;
    RasterOutput drawn = drawer.draw(camera, raster, job);
    const LeafPicture picture{std::move(drawn.group), std::move(drawn.expected_depth)};
    const auto looks = looks_in(*parts, picture);
    for_each_index(looks.size(), [&](std::size_t t) {
      for (std::size_t node = 0; node < looks[t].size(); ++node)
        if (looks[t][node].area > 0) parts->trees[t].looks[node] += looks[t][node];
    });
  }
}

}  // namespace splatcut
