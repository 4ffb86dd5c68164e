#include "segment/selection/box_meanings.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "segment/selection/part_terms.h"

namespace splatcut {

namespace {

constexpr int kBins = 20;  // of the box's extent
using Profile = std::array<float, kBins>;

// Of a leaf or of a node: its pixels outside of the box, and inside by column and by row of it.
struct InBox {
  float outside = 0;
  Profile across{}, down{};

  float inside() const {
    float sum = 0;
    for (const float px : across) sum += px;
    return sum;
  }
  InBox& operator+=(const InBox& other) {
    outside += other.outside;
    for (std::size_t b = 0; b < kBins; ++b) {
      across[b] += other.across[b];
      down[b] += other.down[b];
    }
    return *this;
  }
};

std::size_t bin_of(float at, float low, float extent) {
  return static_cast<std::size_t>(std::clamp(kBins * (at - low) / extent, 0.0f, kBins - 1.0f));
}

std::vector<InBox> of_leaves(const PartHierarchy& parts, const LeafView& view, const BoxPx& box) {
  std::vector<InBox> sums(parts.leaves);
  const glm::vec2 size = box.size_px();
  for (int y = 0; y < view.camera.height_px; ++y)
    for (int x = 0; x < view.camera.width_px; ++x) {
      const glm::vec2 at = glm::vec2(x, y) + 0.5f;
      const bool inside = box.contains(at);
      const std::size_t column = bin_of(at.x, box.low_px.x, size.x), row = bin_of(at.y, box.low_px.y, size.y);
      for (const GroupWeight& w : view.leaves.at(static_cast<std::size_t>(y) * view.camera.width_px + x)) {
        InBox& leaf = sums[w.group];
        if (inside) {
          leaf.across[column] += w.weight;
          leaf.down[row] += w.weight;
        } else {
          leaf.outside += w.weight;
        }
      }
    }
  return sums;
}

// The share of the extent that comes before the first hundredth of the sum.
float margin(auto begin, auto end, float sum) {
  constexpr float kOutermost = 0.01f;
  float before = 0, bins = 0;
  for (auto bin = begin; bin != end; ++bin, ++bins) {
    if (before + *bin >= kOutermost * sum && *bin > 0)
      return (bins + std::max(0.0f, kOutermost * sum - before) / *bin) / kBins;
    before += *bin;
  }
  return 1;
}

// Term kShort.
float short_of_sides(const InBox& of, float inside) {
  constexpr float kTouches = 0.1f;
  float sum = 0;
  for (const Profile* profile : {&of.across, &of.down})
    sum += std::max(0.0f, margin(profile->begin(), profile->end(), inside) - kTouches) +
           std::max(0.0f, margin(profile->rbegin(), profile->rend(), inside) - kTouches);
  return sum;
}

// Terms kShort, kSpill and kFills. inside: px of the part in the box; all_px: of everything in it.
void set_box_terms(const InBox& of, float inside, float all_px, TermValues* terms) {
  constexpr float kMostSpill = 3;
  weight(terms, Term::kShort) = short_of_sides(of, inside);
  weight(terms, Term::kSpill) = std::min(of.outside / inside, kMostSpill);
  weight(terms, Term::kFills) = -std::log(inside / all_px);
}

float all_inside(std::span<const InBox> leaves) {
  float all_px = 0;
  for (const InBox& leaf : leaves) all_px += leaf.inside();
  return all_px;
}

std::vector<PartMeaning> meanings_in_tree(const PartHierarchy& parts, std::uint32_t t,
                                          std::vector<InBox> sums, const std::vector<PartLooks>& here,
                                          float box_area_px, float all_px, const TermValues& weights) {
  constexpr float kLeastShown = 0.02f;  // of the box's area
  const PartTree& tree = parts.trees[t];
  sums.resize(tree.nodes());
  std::vector<PartMeaning> found;
  for (std::uint32_t node = 0; node < tree.nodes(); ++node) {  // children come before their parents
    const InBox& of = sums[node];
    if (tree.parent[node] != kNoPart) sums[tree.parent[node]] += of;
    const float inside = of.inside();
    if (inside < kLeastShown * box_area_px) continue;
    PartMeaning meaning{.tree = t, .node = node};
    PartLooks looks = here[node];
    if (!tree.looks.empty()) looks += tree.looks[node];
    set_look_terms(looks, &meaning.terms);
    weight(&meaning.terms, Term::kCut) = log_cut(tree, node, kLeastFirstCut);
    set_box_terms(of, inside, all_px, &meaning.terms);
    meaning.cost = cost_of(meaning.terms, weights);
    found.push_back(meaning);
  }
  return found;
}

}  // namespace

std::vector<PartMeaning> box_meanings(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                                      const TermValues& weights) {
  const float area_px = box.size_px().x * box.size_px().y;
  if (!(area_px > 0)) return {};
  const std::vector<InBox> leaves = of_leaves(parts, view, box);
  const float all_px = all_inside(leaves);
  const std::vector<std::vector<PartLooks>> here = looks_in(parts, picture_of(view));
  std::vector<std::vector<PartMeaning>> of_tree(parts.trees.size());
  tbb::parallel_for(std::size_t{0}, of_tree.size(), [&](std::size_t t) {
    of_tree[t] =
        meanings_in_tree(parts, static_cast<std::uint32_t>(t), leaves, here[t], area_px, all_px, weights);
  });
  std::vector<PartMeaning> all;
  for (const std::vector<PartMeaning>& some : of_tree) all.insert(all.end(), some.begin(), some.end());
  std::ranges::stable_sort(all, {}, &PartMeaning::cost);
  return all;
}

std::vector<std::uint8_t> agreed_in_box(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                                        std::span<const float> shares, const TermValues& weights) {
  constexpr float kLeastShare = 0.25f, kSameShare = 1e-3f;
  constexpr float kMinority = 0.3f, kBelowHalf = 0.5f;  // cost of a share s below one half: a + b (0.5 - s)
  const std::vector<InBox> leaves = of_leaves(parts, view, box);
  const float all_px = all_inside(leaves);
  std::vector<std::uint32_t> order;  // leaves with votes, those with most of them first
  for (std::uint32_t l = 0; l < shares.size(); ++l)
    if (shares[l] >= kLeastShare) order.push_back(l);
  std::ranges::stable_sort(order, std::greater{}, [&](std::uint32_t l) { return shares[l]; });
  if (!order.empty() && shares[order.front()] <= 0.5f) order.clear();  // nothing for a minority to add to
  InBox sum;
  std::size_t taken = 0;
  float least_cost = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < order.size(); ++i) {
    sum += leaves[order[i]];
    const float share = shares[order[i]], next = i + 1 < order.size() ? shares[order[i + 1]] : 0;
    const float inside = sum.inside();
    const bool half = share > 0.5f;
    const bool ends_share = half ? next <= 0.5f : share - next >= kSameShare;
    if (!ends_share || !(inside > 0)) continue;
    TermValues terms{};
    set_box_terms(sum, inside, all_px, &terms);
    const float cost = cost_of(terms, weights) + (half ? 0 : kMinority + kBelowHalf * (0.5f - share));
    if (cost >= least_cost) continue;
    least_cost = cost;
    taken = i + 1;
  }
  std::vector<std::uint8_t> agreed(parts.leaves, 0);
  for (const std::uint32_t leaf : std::span(order).first(taken)) agreed[leaf] = 1;
  return agreed;
}

float cost_in_box(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                  std::span<const std::uint8_t> set, const TermValues& weights) {
  const std::vector<InBox> leaves = of_leaves(parts, view, box);
  InBox sum;
  for (std::size_t l = 0; l < set.size(); ++l)
    if (set[l]) sum += leaves[l];
  const float inside = sum.inside();
  if (!(inside > 0)) return std::numeric_limits<float>::infinity();
  TermValues terms{};
  set_box_terms(sum, inside, all_inside(leaves), &terms);
  return cost_of(terms, weights);
}

}  // namespace splatcut
