// A mask that is about right made to fit its picture: GrabCut or a pixel graph cut inside the object's
// rectangle.
//
// In: picture, depth (for kPixelCut; may be empty otherwise), prior mask, seeds (draw_seeds; may be empty;
// hard), all of one size. Out: mask of that size. Pixels further than band_px from the prior's border keep
// their side. The pixel cut: an 8-grid over the rectangle with
//   unary     ln of the ratio of Lab histograms of the two sides, counted again in each iteration, plus
//             prior_weight on the prior's side, rising with the distance to its border,
//   pairwise  lambda / distance * exp(-|dLab|^2 / (2 mean |dLab|^2) - depth_weight * relative depth jump),
// minimised exactly by MaxFlow. Source: Boykov, Jolly, Interactive graph cuts, 2001; Rother et al., GrabCut,
// 2004. Cost: some 60-130 ms (GrabCut), 10-40 ms (pixel cut) at 400 px wide. The same on any number of
// threads.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace splatcut {

enum class MaskSolver { kNone, kGrabCut, kPixelCut };

struct RefineOptions {
  MaskSolver solver = MaskSolver::kGrabCut;
  int band_px = 2;  // the prior is right up to about this many pixels of its border
  int grow_px = 0;  // the band reaches that much further outside: a mask too small is the worse mistake
  int iterations = 2;
  float lambda = 4;  // kPixelCut, in units of the unary's logarithms
  float prior_weight = 1;
  float depth_weight = 20;
  bool operator==(const RefineOptions&) const = default;
};

// Returns the prior where there is nothing to do: empty, all of one side, kNone.
Mask refine_mask(const Image<Rgb8>& picture, const Image<float>& depth, const Mask& prior,
                 const RefineOptions& options, const Image<std::uint8_t>& seeds = {});

// The pixel cut with a unary that is known: log_odds, of object against rest, natural logarithms, of the
// prior's size. Pixels band_px or further from the prior's border keep their side. Of the options it takes
// band_px, lambda and depth_weight. Empty prior: it comes back.
Mask cut_by_odds(const Image<Rgb8>& picture, const Image<float>& depth, const Mask& prior,
                 const Image<float>& log_odds, const RefineOptions& options);

}  // namespace splatcut
