// What one view shows of the hierarchy by the Gaussian at each pixel's median depth, and what a mask of it
// means.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "segment/superpoints/part_hierarchy.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

// What one view shows of the parts.
struct PartView {
  struct Tree {
    std::vector<float> pixels;  // per node
  };
  Image<std::uint32_t> leaf;  // kNoPart where nothing is
  std::vector<Tree> trees;
};

// first_hit: RasterOutput::first_hit of the view.
PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit);

// The same from the leaf that each pixel shows; kNoPart: none.
PartView view_parts(const PartHierarchy& parts, Image<std::uint32_t> leaf);

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
