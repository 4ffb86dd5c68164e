#include "segment/selection/part_terms.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace splatcut {

std::vector<float> summed(const PartTree& tree, std::vector<float> of_leaves) {
  of_leaves.resize(tree.nodes(), 0);
  for (std::size_t node = 0; node < tree.nodes(); ++node)  // children come before their parents
    if (tree.parent[node] != kNoPart) of_leaves[tree.parent[node]] += of_leaves[node];
  return of_leaves;
}

std::vector<std::uint8_t> below(const PartTree& tree, std::vector<std::uint8_t> marked) {
  for (std::size_t node = tree.nodes(); node-- > 0;)  // parents before their children
    if (tree.parent[node] != kNoPart) marked[node] |= marked[tree.parent[node]];
  return marked;
}

float log_cut(const PartTree& tree, std::uint32_t node, float least) {
  const float size = std::sqrt(std::max(tree.area[node], 1e-30f));
  return std::max(std::log(std::max(tree.cut[node], 1e-30f) / size), least);
}

void set_look_terms(const PartLooks& looks, TermValues* terms) {
  constexpr float kTiny = 1e-9f;
  constexpr float kSmallShare = 0.01f, kLargeShare = 0.35f;  // of the picture: beyond them it costs
  constexpr float kUnseenNoEdge = 0.5f;                      // of a part no border of which is seen
  const float share = looks.area_squared / std::max(looks.area, kTiny);
  weight(terms, Term::kNoEdge) = looks.border > 0 ? looks.plain_border / looks.border : kUnseenNoEdge;
  weight(terms, Term::kCropped) = looks.cropped_side / std::max(looks.side, kTiny);
  weight(terms, Term::kSmall) = std::max(0.0f, std::log(kSmallShare / std::max(share, kTiny)));
  weight(terms, Term::kLarge) = std::max(0.0f, std::log(std::max(share, kTiny) / kLargeShare));
  weight(terms, Term::kFrame) = looks.frame / std::max(looks.side, kTiny);
}

float cost_of(const TermValues& terms, const TermValues& weights) {
  float sum = 0;
  for (std::size_t t = 0; t < kTerms; ++t) sum += weights[t] * terms[t];
  return sum;
}

}  // namespace splatcut
