#include "segment/selection/box_meanings.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "segment/selection/part_terms.h"

namespace splatcut {

namespace {

constexpr int kBins = PxInBox::kBins;

std::size_t bin_of(float at, float low, float extent) {
  return static_cast<std::size_t>(std::clamp(kBins * (at - low) / extent, 0.0f, kBins - 1.0f));
}

std::vector<PxInBox> of_leaves(const PartHierarchy& parts, const LeafView& view, const BoxPx& box) {
  std::vector<PxInBox> sums(parts.leaves);
  const glm::vec2 size = box.size_px();
  for (int y = 0; y < view.camera.height_px; ++y)
    for (int x = 0; x < view.camera.width_px; ++x) {
      const glm::vec2 at = glm::vec2(x, y) + 0.5f;
      const bool inside = box.contains(at);
      const std::size_t column = bin_of(at.x, box.low_px.x, size.x), row = bin_of(at.y, box.low_px.y, size.y);
      for (const GroupWeight& w : view.leaves.at(static_cast<std::size_t>(y) * view.camera.width_px + x)) {
        PxInBox& leaf = sums[w.group];
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
float short_of_sides(const PxInBox& of, float inside) {
  constexpr float kTouches = 0.1f;
  float sum = 0;
  for (const PxInBox::Profile* profile : {&of.across, &of.down})
    sum += std::max(0.0f, margin(profile->begin(), profile->end(), inside) - kTouches) +
           std::max(0.0f, margin(profile->rbegin(), profile->rend(), inside) - kTouches);
  return sum;
}

}  // namespace

float PxInBox::inside() const {
  return std::accumulate(across.begin(), across.end(), 0.0f);
}

PxInBox& PxInBox::operator+=(const PxInBox& other) {
  outside += other.outside;
  for (std::size_t b = 0; b < kBins; ++b) {
    across[b] += other.across[b];
    down[b] += other.down[b];
  }
  return *this;
}

BoxMeanings::BoxMeanings(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                         const TermValues& weights)
    : parts_(parts),
      view_(view),
      weights_(weights),
      area_px_(box.size_px().x * box.size_px().y),
      leaves_(of_leaves(parts, view, box)) {
  for (const PxInBox& leaf : leaves_) all_px_ += leaf.inside();
}

// Terms kShort, kSpill and kFills.
void BoxMeanings::set_terms(const PxInBox& of, float inside_px, TermValues* terms) const {
  constexpr float kMostSpill = 3;
  weight(terms, Term::kShort) = short_of_sides(of, inside_px);
  weight(terms, Term::kSpill) = std::min(of.outside / inside_px, kMostSpill);
  weight(terms, Term::kFills) = -std::log(inside_px / all_px_);
}

float BoxMeanings::cost(const PxInBox& of) const {
  const float inside_px = of.inside();
  if (!(inside_px > 0)) return std::numeric_limits<float>::infinity();
  TermValues terms{};
  set_terms(of, inside_px, &terms);
  return cost_of(terms, weights_);
}

float BoxMeanings::cost(std::span<const std::uint8_t> set) const {
  PxInBox sum;
  for (std::size_t l = 0; l < set.size(); ++l)
    if (set[l]) sum += leaves_[l];
  return cost(sum);
}

std::vector<PartMeaning> BoxMeanings::in_tree(std::uint32_t t, const std::vector<PartLooks>& here) const {
  constexpr float kLeastShown = 0.02f;  // of the box's area
  const PartTree& tree = parts_.trees[t];
  std::vector<PxInBox> sums = leaves_;
  sums.resize(tree.nodes());
  std::vector<PartMeaning> found;
  for (std::uint32_t node = 0; node < tree.nodes(); ++node) {  // children come before their parents
    const PxInBox& of = sums[node];
    if (tree.parent[node] != kNoPart) sums[tree.parent[node]] += of;
    const float inside_px = of.inside();
    if (inside_px < kLeastShown * area_px_) continue;
    PartMeaning meaning{.tree = t, .node = node};
    PartLooks looks = here[node];
    if (!tree.looks.empty()) looks += tree.looks[node];
    set_look_terms(looks, &meaning.terms);
    weight(&meaning.terms, Term::kCut) = log_cut(tree, node, kLeastFirstCut);
    set_terms(of, inside_px, &meaning.terms);
    meaning.cost = cost_of(meaning.terms, weights_);
    found.push_back(meaning);
  }
  return found;
}

std::vector<PartMeaning> BoxMeanings::all() const {
  if (!(area_px_ > 0)) return {};
  const std::vector<std::vector<PartLooks>> here = looks_in(parts_, picture_of(view_));
  std::vector<std::vector<PartMeaning>> of_tree(parts_.trees.size());
  tbb::parallel_for(std::size_t{0}, of_tree.size(),
                    [&](std::size_t t) { of_tree[t] = in_tree(static_cast<std::uint32_t>(t), here[t]); });
  std::vector<PartMeaning> found;
  for (const std::vector<PartMeaning>& some : of_tree) found.insert(found.end(), some.begin(), some.end());
  std::ranges::stable_sort(found, {}, &PartMeaning::cost);
  return found;
}

std::vector<std::uint8_t> BoxMeanings::agreed(std::span<const float> shares) const {
  constexpr float kLeastShare = 0.25f, kSameShare = 1e-3f;
  constexpr float kMinority = 0.3f, kBelowHalf = 0.5f;  // cost of a share s below one half: a + b (0.5 - s)
  std::vector<std::uint32_t> order;                     // leaves with votes, those with most of them first
  for (std::uint32_t l = 0; l < shares.size(); ++l)
    if (shares[l] >= kLeastShare) order.push_back(l);
  std::ranges::stable_sort(order, std::greater{}, [&](std::uint32_t l) { return shares[l]; });
  if (!order.empty() && shares[order.front()] <= 0.5f) order.clear();  // nothing for a minority to add to
  PxInBox sum;
  std::size_t taken = 0;
  float least_cost = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < order.size(); ++i) {
    sum += leaves_[order[i]];
    const float share = shares[order[i]], next = i + 1 < order.size() ? shares[order[i + 1]] : 0;
    const bool half = share > 0.5f;
    const bool ends_share = half ? next <= 0.5f : share - next >= kSameShare;
    if (!ends_share) continue;
    const float with_these = cost(sum) + (half ? 0 : kMinority + kBelowHalf * (0.5f - share));
    if (with_these >= least_cost) continue;
    least_cost = with_these;
    taken = i + 1;
  }
  std::vector<std::uint8_t> agreed(parts_.leaves, 0);
  for (const std::uint32_t leaf : std::span(order).first(taken)) agreed[leaf] = 1;
  return agreed;
}

}  // namespace splatcut
