// Sizes of what a stroke takes: smaller and larger sets of leaves around it, each inside the next.
//
// In: the set that is taken (of a correction: that changes), all parts that the stroke can mean with their
// costs, pixels per leaf in the stroke's view (of a correction: of what it may change). Out: per leaf, the
// first size that holds it. From a size of p pixels, the next larger one is the cheapest part, of any tree,
// of 1.2 p to 1.5 p pixels that holds at least nine tenths of the size, joined with it. If no part is of
// these pixels, the smallest parts above them take their place. Smaller sizes are found the same way
// downwards and cut with the size above. So sizes are nested whichever trees they come from. No size is found
// below a given number of pixels, for which the set counts if it has fewer. Cost: a pass over the nodes of
// all trees for each size, of which there are about fifteen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/part_votes.h"

namespace splatcut {

struct PartSizes {
  std::vector<std::uint32_t> level;  // per leaf: index of the smallest size that holds it; kNoLevel: none
  std::size_t count = 1;             // number of sizes
  std::size_t taken = 0;             // index of the size that is the set taken

  // Flags per leaf: 1 if the size holds it. size: less than count.
  std::vector<std::uint8_t> leaves(std::size_t size) const;
};

inline constexpr float kLeastSizePx = 1;  // smaller sizes cannot be seen

struct SizeSteps {
  float least_px = kLeastSizePx;  // limit: no smaller size is found
  float next = 1.2f, far = 1.5f;  // ratios of pixels from which, and up to which, a part is the next size
};

// taken: flags per leaf. meanings: parts with their costs, in any order. leaf_px: pixels per leaf. least_px:
// at least kLeastSizePx.
PartSizes part_sizes(const PartHierarchy& parts, std::span<const std::uint8_t> taken,
                     std::span<const PartMeaning> meanings, std::span<const float> leaf_px,
                     const SizeSteps& steps = {});

}  // namespace splatcut
