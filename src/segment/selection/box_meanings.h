// Meanings of a box: the parts that a user may have drawn it around.
//
// In: hierarchy, a box in a soft view, weights. Out: every part of every tree that shows in the box, not only
// the ancestors of one leaf, with its terms (part_model.h names them) and their weighted sum, likeliest
// first. Pixels are the view's, and a leaf counts with its share of each. "All views" are the observing views
// (part_looks.h) and the box's own. Terms of a part that shows `in` pixels in the box:
//
// - kShort: gaps between the part and the box's four sides: the sum of max(0, d - 0.1), where d is the
//   distance of the part's outermost hundredth from a side, over the box's extent that way. People draw boxes
//   that touch the object.
// - kSpill: the part's pixels outside of the box over `in`, at most 3.
// - kFills: -ln(`in` / all pixels that show anything in the box).
// - kCut, kNoEdge, kCropped, kFrame, kSmall, kLarge: the same as for a first click, see candidates.h.
// A part is no meaning if `in` is less than a fiftieth of the box's area.
// Cost: some 10 ms. The result depends on the arguments alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/leaf_view.h"
#include "segment/selection/part_votes.h"

namespace splatcut {

// Of a leaf or a part: its pixels outside of the box, and inside by column and by row of it.
struct PxInBox {
  static constexpr int kBins = 20;  // of the box's extent
  using Profile = std::array<float, kBins>;
  float outside = 0;
  Profile across{}, down{};

  float inside() const;
  PxInBox& operator+=(const PxInBox& other);
};

// The parts, view and weights must live as long as it does. box: in the view's pixels.
class BoxMeanings {
 public:
  BoxMeanings(const PartHierarchy& parts, const LeafView& view, const BoxPx& box, const TermValues& weights);

  // The meanings, likeliest first; empty if nothing shows in the box.
  std::vector<PartMeaning> all() const;

  // What the trees agree on: flags per leaf, 1 for those with more than half of the votes, or with a lower
  // share, down to a quarter, where what that adds fills the box better (kShort, kSpill and kFills of all
  // these leaves together) by more than a minority costs. None where no leaf has more than half. shares: of
  // the votes, per leaf (part_votes.h), or empty.
  std::vector<std::uint8_t> agreed(std::span<const float> shares) const;

  // Cost of a set of leaves by its kShort, kSpill and kFills; infinite if none of it shows in the box.
  float cost(std::span<const std::uint8_t> set) const;

 private:
  void set_terms(const PxInBox& of, float inside_px, TermValues* terms) const;
  float cost(const PxInBox& of) const;
  std::vector<PartMeaning> in_tree(std::uint32_t t, const std::vector<PartLooks>& here) const;

  const PartHierarchy& parts_;
  const LeafView& view_;
  const TermValues& weights_;
  float area_px_;  // of the box
  std::vector<PxInBox> leaves_;
  float all_px_ = 0;  // of everything in the box
};

}  // namespace splatcut
