// From strokes in one view to a mask of that view.
//
// In: the view's picture and depth, strokes in its pixels. Out: mask of the same size.
// The geodesic distance (Dijkstra over the 8-grid, step cost |dLab| + relative depth jump + a little
// length) of each pixel to the object strokes is compared with that to the rest strokes and to the picture's
// frame. Of the level sets nearer to the object, the one whose border has the most contrast is the prior;
// GrabCut or the pixel cut settles it by colour (refine_mask.h). Parts not joined to an object stroke are
// dropped. Cost: about 100 ms at 400 px wide. Does not handle objects that leave the frame on all sides.
#pragma once

#include "core/image.h"
#include "core/job.h"
#include "segment/masks/refine_mask.h"
#include "segment/masks/seeds.h"

namespace splatcut {

struct FirstMaskOptions {
  float depth_weight = 40;     // Lab units per relative depth jump of 1 %: 0.4
  float length_weight = 0.2f;  // Lab units per pixel: keeps flat regions from costing nothing
  RefineOptions refine;        // its band follows from the size of the mask
  bool operator==(const FirstMaskOptions&) const = default;
};

// Empty where no stroke marks the object inside the picture.
Mask first_mask(const Image<Rgb8>& picture, const Image<float>& depth, const Strokes& strokes,
                const FirstMaskOptions& options = {}, const Job& job = {});

}  // namespace splatcut
