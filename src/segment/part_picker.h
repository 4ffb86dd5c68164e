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
#include "segment/part_model.h"
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

struct PickOptions : PickModel {
  int scale_steps =
      0;  // along first_chain from what looks most likely: -1 the next smaller, +1 the next larger
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
std::vector<std::uint8_t> parts_of_mask(const PartHierarchy& parts, const PartView& view, const Mask& mask,
                                        const MaskToPartsOptions& options = {});

// Labels per Gaussian of a selection of leaves.
std::vector<std::uint8_t> labels_of(const PartHierarchy& parts, const std::vector<std::uint8_t>& leaves);

// The selection as the view shows it.
Mask mask_of(const PartView& view, const std::vector<std::uint8_t>& leaves);

}  // namespace splatcut
