// From strokes in one view to a mask of that view.
//
// In: the view's picture and depth, strokes in its pixels. Out: mask of the same size.
// The geodesic distance (Dijkstra over the 8-grid, step cost |dLab| + relative depth jump + a little
// length) of each pixel to the object strokes is compared with that to the rest strokes and to the picture's
// frame. Of the level sets nearer to the object, the one whose border has the most contrast is the prior. GrabCut (Rother et al., 2004; OpenCV) settles colour inside the
// object's rectangle. Parts not joined to an object stroke are dropped.
// Cost: about 100 ms at 400 px wide. Does not handle objects that leave the frame on all sides.
#pragma once

#include "scene/image.h"
#include "scene/job.h"
#include "segment/seeds.h"

namespace splatcut {

struct FirstMaskOptions {
  float depth_weight = 40;   // Lab units per relative depth jump of 1 %: 0.4
  float length_weight = 0.2f;  // Lab units per pixel: keeps flat regions from costing nothing
  int grabcut_iterations = 2;
};

// Throws Error when no stroke marks the object.
Mask first_mask(const Image<Rgb8>& picture, const Image<float>& depth, const Strokes& strokes,
                const FirstMaskOptions& options = {}, const Job& job = {});

// GrabCut of `prior` inside its rectangle: pixels further than `band_px` from the prior's border keep
// their side. Seeds (see draw_seeds; may be empty) are hard. Returns the prior where GrabCut has nothing to do.
Mask refine_mask(const Image<Rgb8>& picture, const Mask& prior, int band_px, int iterations,
                 const Image<std::uint8_t>& seeds = {});

}  // namespace splatcut
