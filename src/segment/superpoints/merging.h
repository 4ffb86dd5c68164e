// One tree of parts: superpoints, merged two at a time, the cheapest pair of neighbours first.
//
// In: surface Gaussians, the edges between them, the leaf of each. Out: a PartTree. Cost of a merger, with
// the weights of MergingOptions:
//   difference of the parts * (area of the smaller / median of the leaves)^area_power
//                           / (share of its border that both share)^border_power,   times e^(noise x), x of
//   mean 0 and variance 1, the same for the same tree and parts.
// Each border between two parts stands in memory once, and both list it, so that a merger costs as much as
// the parts have neighbours. Same input, same bits: ties go to the lower indices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/counter_rng.h"
#include "core/job.h"
#include "segment/superpoints/superpoints.h"

namespace splatcut {

inline constexpr std::uint64_t kTreeSeed = 20241;
inline constexpr float kTiny = 1e-30f;  // less than any area or length of a scene

// A number of mean 0 and variance 1.
inline float spread(CounterRng& rng) {
  return rng.between(-1.7320508f, 1.7320508f);
}

// Which leaves are neighbours: the same for all trees.
struct LeafBorders {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::array<std::uint32_t, 2>> leaves;  // of each border, the lower one first
  std::vector<std::uint32_t> of_edge;                // per surface edge; kNone within a leaf
};
LeafBorders leaf_borders(const Superpoints& leaves, std::span<const SurfaceEdge> edges);

struct MergingInput {
  const SurfaceFeatures& features;
  std::span<const SurfaceEdge> edges;
  const Superpoints& leaves;
  const LeafBorders& borders;  // of leaves and edges
};

// noise: 0 for none. tree: its number. Cancelled: the tree is incomplete.
PartTree merged_tree(const MergingInput& in, const MergingOptions& options, float noise, std::uint64_t tree,
                     const Job& job);

}  // namespace splatcut
