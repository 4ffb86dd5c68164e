// Takes off an object what its labels' own pictures do not show: hidden pieces leave, splats that stick out
// are cut at the border and the inner part stays.
//
// In: the object's Gaussians, those of its own views (own_views.h) that it goes by. Sums of alpha T over
// valid pixels of the object drawn alone, per Gaussian: A over all, M inside, F more than 2 px outside; w = M
// / A.
//   over all views   w < .5 and F / A > .05: leaves. So does what is in no picture, a lump below the table:
//                    its middle lies 2 % of its depth behind the scene's in all views, and in more than a
//                    quarter of those that hold it farther than 2 % of the object from the mask
//   view by view     A > .3 px, F / A > .05: leaves where w < .05 and w of all views < .75; cut where
//                    .05 <= w < .93, along the projected line across which its inner and outer part lie, at
//                    the depth that leaves w inside (half_gaussian.h)
// Only the inner part is kept: the outer half of a splat at the border is a floater, alone. It may be the
// scene's, see forget.h. Cost: two drawings of the object a view.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/job.h"
#include "segment/finish/half_gaussian.h"
#include "segment/finish/own_views.h"

namespace splatcut {

// What the object lost: the outer part of a Gaussian that was cut, or one that left.
struct CutOff {
  std::uint32_t of = 0;  // its index in the object
  SolidGaussian part;
};

struct CarveReport {
  std::size_t left = 0, split = 0;  // Gaussians
  std::vector<CutOff> cut_off;      // by view, then by Gaussian; those that left come last
};

// kept: per Gaussian of the object, those that leave get 0.
CarveReport carve(std::span<const OwnView> views, GaussianCloud* object, std::vector<std::uint8_t>* kept,
                  const Job& job);

}  // namespace splatcut
