// What clicks and strokes mean: a selection of parts.
//
// In: the hierarchy, one view of it, strokes in that view's pixels. Out: per leaf whether it is selected.
// A click lands on a leaf; the leaf's ancestors in all trees are what it can mean. Taken is the one that
// looks most like an object: little border towards its like, not touching the picture's frame, of no odd
// size, and held by the other trees, too. An ancestor that holds a click of the other sign is no candidate.
// Object clicks only add, rest clicks only remove; after the first, changes are no larger than the click's
// distance to the present border makes likely. A later object click prefers a part that holds all object
// clicks so far: the second may find that the first took a crumb; from the third on, parts much larger than
// the selection are less likely. Cost: the ancestors of the clicked leaves; below a millisecond once the view
// is known.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/image.h"
#include "segment/part_hierarchy.h"
#include "segment/seeds.h"

namespace splatcut {

// What one view shows of the parts.
struct PartView {
  struct Tree {
    std::vector<float> pixels;        // per node
    std::vector<float> frame_pixels;  // per node: pixels at the picture's frame
  };
  Image<std::uint32_t> leaf;  // kNoPart where nothing is
  std::vector<Tree> trees;
};

// first_hit: RasterOutput::first_hit of the view.
PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit);

struct PickOptions {
  int scale_steps =
      0;  // along first_chain from what looks most likely: -1 the next smaller part, +1 the next larger
  float doubt = 0.25f;  // how much more likely the first click's part must be than others to count as clear
  float stability_weight = 3;  // of -ln of the mean IoU with the other trees' likest parts

  // Logarithms of folds unless said otherwise; fitted on the scenes of docs/masks.md, not held out.
  float rise_bonus = 0.0095f;
  float cut_weight = 0.094f, jump_bonus = 0.17f, root_penalty = 0.011f;
  float frame_penalty = 1.9f;
  float small_share = 0.01f, large_share = 0.35f;  // of the picture's pixels
  float small_penalty = 2, large_penalty = 0.55f;
  float least_log_cut = -16;
  float growth_penalty = 0.01f, growth_slack = 0.5f;         // of additions larger than what is selected
  float late_growth_penalty = 1, late_growth_slack = 0.69f;  // the same from the third object click on
  float change_small =
      0.2f;  // of later clicks that change less than a disc which reaches from the click to the border
  float change_large = 3.4f, change_slack = 3.25f, change_most = 2.7f;  // of later clicks
  float change_most_of_selected =
      1;  // an object click farther than border_px from the selection may add that much
  float rest_most_of_selected = 0.25f;  // and a rest click may remove that much
  float border_px = 2;                  // nearer ones mend its border
  float joint_bonus = 1;                // of later object clicks, for a part that holds all of them
  float hidden_penalty = 1,
        hidden_slack = 2;  // of later clicks that bring much of what the view hides, per pixel
};

struct PartNode {
  std::size_t tree = 0;
  std::uint32_t node = 0;
};

struct Pick {
  std::vector<std::uint8_t> leaves;  // per leaf, 1 = selected
  std::vector<PartNode>
      first_chain;  // what the first click can mean: one tree's parts, small to large, told apart
  std::size_t first_chosen = 0;  // index into first_chain
  bool ambiguous = false;        // a part of another size looked nearly as likely
};

// Strokes in order, later ones correct earlier ones; rest strokes told before any object count right after
// the first object stroke. Strokes that hit nothing do nothing.
Pick pick_parts(const PartHierarchy& parts, const PartView& view, const Strokes& strokes,
                const PickOptions& options = {});

// The leaves that a mask of the view means: per tree the nodes that agree best with it in pixels, whole nodes
// rather than their children where that loses little, so that the side turned away belongs to it as well;
// leaves that most trees choose. mask: same size as the view.
struct MaskToPartsOptions {
  float tolerance = 0.15f;      // pixels that a whole node may lose against its children, share of its own
  float least_visible = 0.05f;  // share of a node's area in leaves that the view shows
};
std::vector<std::uint8_t> parts_of_mask(const PartHierarchy& parts, const PartView& view, const Mask& mask,
                                        const MaskToPartsOptions& options = {});

// Labels per Gaussian of a selection of leaves.
std::vector<std::uint8_t> labels_of(const PartHierarchy& parts, const std::vector<std::uint8_t>& leaves);

// The selection as the view shows it.
Mask mask_of(const PartView& view, const std::vector<std::uint8_t>& leaves);

}  // namespace splatcut
