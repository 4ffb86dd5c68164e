// What clicks and strokes mean: a selection of parts.
//
// In: the hierarchy, one view of it, strokes in that view's pixels. Out: per leaf whether it is selected.
// A click lands on a leaf and climbs to the ancestor that looks most like an object:
//   least  ln(cut / sqrt(area)) - rise_bonus max(0, rise of that towards the parent) + penalties
// with penalties for touching the picture's frame and for an odd size in the picture. An ancestor that
// holds a click of the other sign is no candidate. Object clicks only add, rest clicks only remove; after the
// first, sizes near the click's distance to the present border are preferred.
// Cost: the ancestors of the clicked leaves; below a millisecond once the view is known.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/image.h"
#include "segment/part_hierarchy.h"
#include "segment/seeds.h"

namespace splatcut {

// What one view shows of the parts.
struct PartView {
  Image<std::uint32_t> leaf;         // kNoPart where nothing is
  std::vector<float> pixels;         // per node
  std::vector<float> frame_pixels;   // per node: pixels at the picture's frame
};

// first_hit: RasterOutput::first_hit of the view.
PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit);

struct PickOptions {
  float rise_bonus = 0.013f;
  float cut_weight = 0.2f, jump_bonus = 0.53f, root_penalty = 1.6f;
  float frame_penalty = 2.9f;
  float small_share = 0.01f, large_share = 0.35f;  // of the picture's pixels
  float small_penalty = 0.3f, large_penalty = 2.2f;
  float least_log_cut = -16;
  float growth_penalty = 0, growth_slack = 0.7f;  // of additions larger than what is selected
  float change_large = 2.8f, change_small = 1.3f, change_slack = 3.4f, change_most = 5.2f;  // of later clicks
};

struct Pick {
  std::vector<std::uint8_t> leaves;         // per leaf, 1 = selected
  std::vector<std::uint32_t> first_chain;   // ancestors of the first click's leaf, from small to large
  std::size_t first_chosen = 0;             // index into first_chain
};

// Strokes in order, later ones correct earlier ones. Strokes that hit nothing do nothing.
Pick pick_parts(const PartHierarchy& parts, const PartView& view, const Strokes& strokes, const PickOptions& options = {});

// Labels per Gaussian of a selection of leaves.
std::vector<std::uint8_t> labels_of(const PartHierarchy& parts, const std::vector<std::uint8_t>& leaves);

// The selection as the view shows it.
Mask mask_of(const PartView& view, const std::vector<std::uint8_t>& leaves);

}  // namespace splatcut
