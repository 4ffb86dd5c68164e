// What a click can mean: candidates, with the terms of their cost.
//
// In: hierarchy, what was selected so far, a click in a soft view. Out: the clicked leaf's ancestors in every
// tree, each with its terms (part_model.h names them) and their weighted sum, likeliest first; the disc alone
// and, after one click on the object, another meaning of that click are candidates, too. All pixels are the
// view's; "all views" are the observing ones (part_looks.h), of a first click with its own: a part looks the
// same from wherever the user stands. Terms:
//
// - kCut: ln(length of the node's border, likeness-weighted / sqrt(area)), in the scene; where it touches
//   nothing -16, of a first click -12.
// - kJump: ln of how much dearer the merge that ends the node is than the one that made it, at most 2.
// - kRare: -ln of the mean IoU (at least 0.01) with the likest ancestors in the other trees of its kind; of a
//   first click in pixels of all views.
// - kFrame: pixels at the picture's frame / sqrt(all); of a first click both are summed over all views.
// - kShadeBlind: 1 where the tree counts lightness less.
// - kOffCentre: ln(0.7 / share), at least 0; share: the click's distance to the border of what would change
//   over the largest such distance. People click in the middle of what they mean.
// - kNoEdge: of a first click, share of its border in all views where the depth does not jump.
// - kCropped: of a first click, the share of the views in which it touches the picture's frame; views count
//   by the side of what they show of it.
// - kSmall, kLarge: of a first click, ln of folds of the picture below 1 % and above 35 %; of the picture in
//   which its average pixel lies.
// - kScrap, kFold, kGiant: of later clicks, with f = ln(changed pixels / disc to where the region may end):
//   max(0, -0.3 - f), max(0, f - 1), max(0, f - 3.25).
// - kApart: share of the view's pixels that would change which the click does not reach without a jump in
//   depth (click_reach.h): another thing behind or before. People click each thing that is wrong.
// - kBorder: max(0, f - 1) where the click is within 2 pixels of the border.
// - kHidden: max(0, ln(H) - 2), H: area that would change, at the clicked leaf's depth, over changed pixels
//   or that disc: what would mostly change where the user cannot see it.
// - kTakes: of a click on the rest, max(0, -ln(share of the object's pixels in the view that would be left) -
//   0.4): people take parts away from an object, and undo where they want nearly all of it gone.
// - kOpposed: clicks of the other sign that it holds.
// - kBack: IoU with what a click of the other sign has changed, the largest. People undo in that case.
// - kDisc: 1 where nothing but the disc would change.
// - kRepick: 1 where the first click is given another meaning; see ClickSelection. It is a candidate while f
//   is at most 1, and has none of the other terms but those of size.
// Cost: some 10 ms. The result depends on the arguments alone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "segment/selection/leaf_view.h"
#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

inline constexpr float kLeastChangePx = 0.3f;  // candidates that change less change nothing

// The candidates of one tree: the clicked leaf and its ancestors.
struct Chain {
  std::vector<std::uint32_t> nodes;  // the leaf and its ancestors
  std::vector<std::uint32_t>
      level;  // per leaf of the hierarchy: the first of the nodes that holds it, or kNoLevel
  std::vector<float> view_px, frame_px, opposed, changed_px, changed_area, stability;  // per node
  std::vector<PartLooks> looks;  // of a first click, per node: in the observing views and its own
  bool shade_blind = false;
  bool of_tree = true;  // false: a set of leaves that no tree holds
};

struct Candidate {
  static constexpr std::size_t kDiscAlone = ~std::size_t{0};
  std::size_t chain = 0, index = 0;  // into that chain's nodes; kDiscAlone: no part
  TermValues terms{};
  float cost = 0;
};

// All candidates of a click, and what their terms are computed from.
struct Answers {
  std::vector<Chain> chains;
  std::vector<Candidate> candidates;  // likeliest first
  std::vector<std::uint8_t> free;     // per leaf: whether a candidate may change it

  bool changes(const Candidate& candidate, std::uint32_t leaf) const {
    return candidate.index != Candidate::kDiscAlone &&
           chains[candidate.chain].level[leaf] <= candidate.index &&
           (free[leaf] || !chains[candidate.chain].of_tree);
  }
};

// What one correction has changed.
struct Change {
  std::vector<std::uint32_t> leaves;
  bool object = false;
};

// The state after the clicks so far.
struct SelectedParts {
  std::vector<std::uint8_t> object;       // per leaf
  std::vector<std::int8_t> said;          // per leaf: +1, -1: decided by a disc
  std::vector<std::uint32_t> clicked[2];  // leaves clicked, by sign
  std::vector<Change> changes;            // by each correction
  std::shared_ptr<const Answers> first;   // what the first click could mean
};

struct Click {
  const LeafView& view;
  glm::ivec2 at;
  bool object;
  bool first;
  std::uint32_t leaf;     // not on that side yet
  float radius_px;        // to where the wrong region may end; 0 for the first
  const Mask& displayed;  // before the click
};

struct AnswerOptions {
  bool all_terms = false;  // else kOffCentre is measured of those alone that can win by it,
  float least_growth = 1;  // in changed pixels from one node of a chain to the next that is a candidate
};

// model: its weights say how much each term costs.
Answers answers(const PartHierarchy& parts, const SelectedParts& selected, const Click& click,
                const SelectionModel& model, const AnswerOptions& options = {});

}  // namespace splatcut
