// What a box around something can mean: every part of every tree that shows in it, not only the ancestors of
// one leaf, each with its terms (part_model.h names them) and their weighted sum, likeliest first.
//
// In: hierarchy, a box in a soft view, weights. All pixels are the view's, soft; "all views" are the
// observing ones (part_looks.h) with the box's own. Terms, of a part of which `in` pixels lie in the box:
//
// - kShort: how far the part stays away from the box's four sides: sum of max(0, d - 0.1), d the distance of
//   its outermost hundredth from the side over the box's extent that way. A box touches what it is around.
// - kSpill: its pixels outside of the box / in, at most 3.
// - kFills: -ln(in / all that shows in the box).
// - kCut, kNoEdge, kCropped, kFrame, kSmall, kLarge: as of a first click, see candidates.h.
// Parts of which less than a fiftieth of the box's area shows in it are none of its meanings.
// Cost: some 10 ms. The result depends on the arguments alone.
#pragma once

#include <span>
#include <vector>

#include "segment/selection/leaf_view.h"
#include "segment/selection/part_votes.h"

namespace splatcut {

// Empty where the box shows nothing.
std::vector<PartMeaning> box_meanings(const PartHierarchy& parts, const LeafView& view, const BoxPx& box,
                                      const TermValues& weights);

}  // namespace splatcut
