// Trees of parts against sums over all pairs of parts, made again from the edges before each merger.
#include "segment/superpoints/merging.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

using namespace splatcut;

namespace {

// Gaussians of random leaves, `edges` random pairs of them.
struct RandomSurface {
  SurfaceFeatures features;
  std::vector<SurfaceEdge> edges;
  Superpoints leaves;

  RandomSurface(std::uint32_t leaf_count, std::size_t edge_count, std::uint64_t seed) {
    CounterRng rng(seed, 0);
    const std::uint32_t n = 4 * leaf_count;
    leaves.count = leaf_count;
    for (std::uint32_t i = 0; i < n; ++i) {
      features.core.push_back(i);
      leaves.of.push_back(i < leaf_count ? i
                                         : static_cast<std::uint32_t>(rng.between(0, 1) * 0.999f *
                                                                      static_cast<float>(leaf_count)));
      features.spacing.push_back(rng.between(0.1f, 1));
      features.colour.emplace_back(rng.between(0, 1), rng.between(0, 1), rng.between(0, 1));
    }
    const auto any = [&] {
      return static_cast<std::uint32_t>(rng.between(0, 0.999f) * static_cast<float>(n));
    };
    for (std::size_t e = 0; e < edge_count; ++e) {
      const auto [a, b] = std::minmax({any(), any()});
      edges.push_back({a, b, rng.between(0, 1), rng.between(0, 2), rng.between(-1, 1), rng.between(0, 20),
                       rng.between(0.1f, 1), 1});
    }
  }
};

using Side = std::vector<std::uint32_t>;  // nodes' leaves

// Everything that merging weighs, from the definitions in merging.h and part_model.h, in double precision.
struct ByHand {
  const RandomSurface& s;
  MergingOptions o;
  std::map<std::uint32_t, Side> parts;

  bool in(const Side& side, std::uint32_t gaussian) const {
    return std::ranges::find(side, s.leaves.of[gaussian]) != side.end();
  }
  double area(const Side& side) const {
    double sum = 0;
    for (const std::uint32_t i : s.features.core)
      if (in(side, i)) sum += std::pow(s.features.spacing[i], 2);
    return sum;
  }
  glm::dvec3 colour(const Side& side) const {
    glm::dvec3 sum(0);
    for (const std::uint32_t i : s.features.core)
      if (in(side, i)) sum += std::pow(s.features.spacing[i], 2) * glm::dvec3(s.features.colour[i]);
    return sum / area(side);
  }
  double perimeter(const Side& side) const {
    double sum = 0;
    for (const SurfaceEdge& e : s.edges) sum += in(side, e.a) != in(side, e.b) ? e.length : 0;
    return sum;
  }
  // Length of the border; none where the two are no neighbours.
  std::optional<double> length(const Side& a, const Side& b) const {
    std::optional<double> sum;
    for (const SurfaceEdge& e : s.edges)
      if ((in(a, e.a) && in(b, e.b)) || (in(a, e.b) && in(b, e.a))) sum = sum.value_or(0) + e.length;
    return sum;
  }
  double difference(const Side& a, const Side& b) const {
    double colour_sum = 0, concave = 0, convex = 0, normal = 0, gap = 0;
    for (const SurfaceEdge& e : s.edges) {
      if (!((in(a, e.a) && in(b, e.b)) || (in(a, e.b) && in(b, e.a)))) continue;
      colour_sum += e.length * e.colour;
      concave += e.length * std::max(0.0f, e.concavity);
      convex += e.length * std::max(0.0f, -e.concavity);
      normal += e.length * e.normal;
      gap += e.length * std::min(o.gap_most, o.gap_unit * e.gap);
    }
    const double l = *length(a, b);
    return o.base + o.border_colour * colour_sum / l + o.region_colour * glm::length(colour(a) - colour(b)) +
           o.concavity * std::max(0.0, concave - o.convexity * convex) / l + o.normal * normal / l +
           o.gap * gap / l;
  }
  double cut(std::uint32_t p) const {
    double sum = 0;
    for (const auto& [q, side] : parts)
      if (q != p && length(parts.at(p), side))
        sum += *length(parts.at(p), side) * std::exp(-difference(parts.at(p), side) / o.cut_scale);
    return sum;
  }
  double cost(const Side& a, const Side& b, double median_area) const {
    const double shared = *length(a, b) / std::min(perimeter(a), perimeter(b));
    return difference(a, b) * std::pow(std::min(area(a), area(b)) / median_area, o.area_power) /
           std::pow(std::clamp(shared, 1e-6, 1.0), o.border_power);
  }
};

}  // namespace

TEST_CASE("merging: the cheapest pair each time, as found by weighing all pairs anew") {
  for (const auto& [leaves, edges] : {std::pair{2u, 3u}, {12u, 60u}, {20u, 40u}, {25u, 400u}}) {
    const RandomSurface s(leaves, edges, leaves + edges);
    ByHand hand{s, {}, {}};
    std::vector<double> areas;
    for (std::uint32_t l = 0; l < leaves; ++l) {
      hand.parts[l] = {l};
      areas.push_back(hand.area({l}));
    }
    std::ranges::sort(areas);
    const PartTree tree =
        merged_tree({s.features, s.edges, s.leaves, leaf_borders(s.leaves, s.edges)}, {}, 0, 0, {});
    REQUIRE(tree.nodes() >= leaves);
    for (std::uint32_t l = 0; l < leaves; ++l)
      CHECK(tree.cut[l] == doctest::Approx(hand.cut(l)).epsilon(1e-4));
    for (auto node = leaves;; ++node) {
      CAPTURE(node);
      std::optional<double> least;
      std::pair<std::uint32_t, std::uint32_t> best;
      for (const auto& [p, a] : hand.parts)
        for (const auto& [q, b] : hand.parts) {
          if (p >= q || !hand.length(a, b)) continue;
          const double cost = hand.cost(a, b, areas[areas.size() / 2]);
          if (!least || cost < *least) least = cost, best = {p, q};
        }
      if (!least) {
        CHECK(tree.nodes() == node);
        break;
      }
      REQUIRE(node < tree.nodes());
      CHECK(tree.children[node] == std::array{best.first, best.second});
      CHECK(tree.parent[best.first] == node);
      CHECK(tree.parent[best.second] == node);
      CHECK(tree.merge_cost[node] == doctest::Approx(*least).epsilon(1e-4));
      Side both = hand.parts[best.first];
      std::ranges::copy(hand.parts[best.second], std::back_inserter(both));
      hand.parts.erase(best.first);
      hand.parts.erase(best.second);
      hand.parts[node] = both;
      CHECK(tree.area[node] == doctest::Approx(hand.area(both)).epsilon(1e-4));
      CHECK(tree.cut[node] == doctest::Approx(hand.cut(node)).epsilon(1e-4));
    }
  }
}
