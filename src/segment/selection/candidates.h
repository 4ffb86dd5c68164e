// Candidates: what a click can mean, with the terms of the cost of each meaning.
//
// In: hierarchy, the selection so far, a click in a soft view. Out: candidates, likeliest first, each with
// its terms (part_model.h names them) and their weighted sum. Candidates are the ancestors of the clicked
// leaf in every tree. For corrections, the disc alone is one more candidate. So is another meaning of what
// was said first, click or box, that no click speaks against. Pixels are the view's. "All views" are the
// observing views (part_looks.h), for a first click together with its own if that is no close-up
// (usual_picture.h), so that a part looks the same from wherever the user stands. f is ln(pixels that would
// change / area of the disc that reaches to where the wrong region may end). Terms of a candidate:
//
// - kCut: ln(L / sqrt(area)), with L the length of the node's border in the scene, weighted by likeness; at
//   least -16, for a first click at least -12: a node that touches nothing gets that.
// - kJump: ln(cost of the merge that ends the node / cost of the merge that made it), from 0 to 2.
// - kRare: -ln of the node's mean IoU (at least 0.01) with the likest ancestors in the other trees of its
//   kind; for a first click IoU counts pixels of all views.
// - kFrame: pixels at the picture's frame / sqrt(all pixels of the node); for a first click both are sums
//   over all views.
// - kShadeBlind: 1 if the tree gives lightness less weight.
// - kOffCentre: ln(0.7 / share), at least 0. share: the click's distance to the border of what would change,
//   over the largest such distance. People click in the middle of what they mean.
// - kNoEdge (first clicks): share of the node's border, in all views, at which depth does not jump.
// - kCropped (first clicks): share of the views in which the node touches the picture's frame. A view counts
//   by the square root of the area that it shows of the node.
// - kSmall, kLarge (first clicks): ln of how many times the node is smaller than 1 %, or larger than 35 %, of
//   the picture in which its average pixel lies.
// - kScrap, kFold, kGiant (later clicks): max(0, -0.3 - f), max(0, f - 1), max(0, f - 3.25).
// - kApart (later clicks): share of the pixels that would change which the click does not reach without a
//   jump in depth (click_reach.h): they are another thing behind or before. People click each thing that is
//   wrong.
// - kBorder (later clicks): max(0, f - 1) if the click is within 2 pixels of the border.
// - kHidden (later clicks): max(0, ln(H) - 2). H: area that would change, in pixels at the clicked leaf's
//   depth, over the pixels that would change or the disc's, whichever are more. It is large if most of the
//   change is where the user cannot see it.
// - kTakes (later clicks): on the rest max(0, -ln(share of the object's pixels in the view that would be
// left)
//   - 0.4): people take parts away from an object, and undo if they want nearly all of it gone. On the
//   object, from the second correction on, max(0, ln(how many times as many there would be) - 0.7): by then
//   most of it is there, and a cable's table is not meant.
// - kOpposed: number of clicks of the other sign in the node.
// - kBack (later clicks): largest IoU with what a click of the other sign has changed. People undo in that
//   case.
// - kAgain (the second to the fifth correction): 1 if the one before was of the same sign and the node holds
//   the leaf that it clicked. A second click of one sign in a row mostly says that the first one took too
//   little. Later corrections mend details, and so do those after a box, which says how far a thing reaches.
//   Less where kApart is above a half, down to 0: that is another thing.
// - kDisc: 1 if nothing but the disc would change.
// - kRepick (clicks on the rest): 1 if the first click gets the likeliest other meaning that is left
//   (first_meanings.h). This is a candidate if the first click is the only one on the object and f is at most
//   1. Of the other terms it has kDoubtful and kScrap.
// - kAgreed: 1 if what was said first gets the meaning that the trees agree on among those that are left.
//   This is a candidate where kRepick is none, and if it costs at most 0.4: dearer ones were cheapest at
//   times, and wrong. Of the other terms it has kDoubtful, kDearer, kScrap, kFold, kGiant, kBorder and
//   kTakes.
// - kDoubtful (of these two): AgreedMeaning::doubt of the meanings that are left.
// - kDearer (of kAgreed, for clicks on the object, and on the rest after a box): what the likeliest meaning
//   that is left costs more than the likeliest of all.
// Cost: some 10 ms. The result depends on the arguments alone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "segment/selection/leaf_view.h"
#include "segment/selection/part_votes.h"
#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

inline constexpr float kLeastChangePx = 0.3f;  // limit: a candidate that changes fewer pixels is none

// The candidates of one tree: the clicked leaf and its ancestors.
struct Chain {
  std::vector<std::uint32_t> nodes;  // nodes of the tree, from the leaf to the root
  // Index of the first node in `nodes` that holds each leaf of the hierarchy, or kNoLevel.
  std::vector<std::uint32_t> level;
  // Values per node: pixels in the view and at its frame, clicks of the other sign, pixels and scene area
  // that would change, and mean IoU with the other trees.
  std::vector<float> view_px, frame_px, opposed, changed_px, changed_area, stability;
  std::vector<PartLooks> looks;  // looks per node in all views, for a first click only
  bool shade_blind = false;      // true: the tree gives lightness less weight
  bool of_tree = true;           // false: the chain is a set of leaves that no tree holds
};

struct Candidate {
  static constexpr std::size_t kDiscAlone = ~std::size_t{0};
  std::size_t chain = 0, index = 0;  // index of the chain, and in its nodes; index kDiscAlone: no part
  TermValues terms{};
  float cost = 0;
};

// All candidates of a click, and what their terms are computed from.
struct Answers {
  std::vector<Chain> chains;
  std::vector<Candidate> candidates;  // candidates, likeliest first
  std::vector<Candidate> unlikely;    // those dropped before kOffCentre was measured
  std::vector<std::uint8_t> free;     // flags per leaf: 1 if a candidate may change it

  // True if the candidate holds the leaf and may change it.
  bool changes(const Candidate& candidate, std::uint32_t leaf) const {
    return candidate.index != Candidate::kDiscAlone &&
           chains[candidate.chain].level[leaf] <= candidate.index &&
           (free[leaf] || !chains[candidate.chain].of_tree);
  }
};

// Change that one correction has made.
struct Change {
  std::vector<std::uint32_t> leaves;  // leaves that changed side
  std::uint32_t clicked = kNoPart;    // the leaf that the click was on; of a box none
  bool object = false;                // true: they became object
};

// Selection after the clicks so far.
struct SelectedParts {
  std::vector<std::uint8_t> object;  // labels per leaf, 1 = object
  std::vector<std::int8_t> said;     // sign per leaf that a disc has decided: +1 object, -1 rest; 0: none
  std::vector<std::uint32_t> clicked[2];  // leaves clicked: [0] on the rest, [1] on the object
  std::vector<Change> changes;            // change of each correction
  std::shared_ptr<const std::vector<PartMeaning>>
      meanings;        // what was said first can mean, likeliest first; null before it
  bool boxed = false;  // true: a box was first
};

struct Click {
  const LeafView& view;
  glm::ivec2 at;          // clicked pixel
  bool object;            // true: the click says object; false: rest
  bool first;             // true: it is the first click
  std::uint32_t leaf;     // leaf that the click shall change: it is on the other side
  float radius_px;        // distance to where the wrong region may end; 0 for the first click
  const Mask& displayed;  // mask that the view showed before the click
};

struct AnswerOptions {
  // True: kOffCentre is measured for all candidates. False: only for those that can win by it; others are
  // dropped.
  bool all_terms = false;
  // True: a first click's view is a close-up (is_close_up()) and may crop what is meant.
  bool close_up = false;
  float least_growth = 1;  // least ratio of changed pixels from one candidate of a chain to the next
};

// Finds the candidates of a click. model: its weights say what each term costs.
Answers answers(const PartHierarchy& parts, const SelectedParts& selected, const Click& click,
                const SelectionModel& model, const AnswerOptions& options = {});

}  // namespace splatcut
