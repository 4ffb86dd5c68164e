// An object by itself, as one keeps it: how near its pictures without the scene come to the truth's.
//
// Truth in a test view: the alpha and the colours of the true labels alone, without what a generator says
// that a perfect capture would not hold; where only masks are known, the mask as alpha and the scene's own
// picture within it. Over a background both are blended by their alpha. Means over the test views that count:
//   iou            of alpha > .5
//   boundary_iou   of the bands within 2 px, and within 2 % of the picture's diagonal, of both borders
//   psnr, ssim     within the box of the true mask, on black and on magenta (ssim on black)
//   halo           sum of alpha in excess of the truth's, more than 2 px outside of it, over its area
//   missing        sum of alpha short of the truth's, more than 2 px inside of it, over its area
//   alpha_error    sum of |alpha - truth's alpha| over its area
// Where the true labels are known, the same also in a ring of twelve cameras around the true object, 22.5
// degrees above it, 320 px wide: it shows the sides that no test view does. Without cameras of a capture,
// where clean edges look from such a ring, too, these stand between theirs.
// And of what is left of the scene without the object: PSNR to the scene in the ring from 2 to 12 px outside
// of the mask, and the mean gradient along the mask's border, levels of 255 a pixel, where a ghost shows.
#pragma once

#include <optional>

#include "segment/finish/clean.h"

namespace splatcut {

struct AloneScore {
  double iou = 0, boundary_iou_2px = 0, boundary_iou_2pct = 0;
  double psnr_black_db = 0, psnr_magenta_db = 0, ssim = 0;
  double halo = 0, missing = 0, alpha_error = 0;
};

struct RestScore {
  double ring_psnr_db = 0, ghost_gradient = 0;
};

// One cutout, or the mean of some.
struct CutoutScore {
  AloneScore kept, clean;                           // its Gaussians as they are, and with clean edges
  std::optional<AloneScore> kept_ring, clean_ring;  // the same in the ring; none: labels are not known
  RestScore rest, clean_rest;  // the scene's others as they are, and as forget.h has them
  double cleaned = 0;          // share of the cutouts that were cleaned
  double clean_ms = 0;
  CleanReport report;  // of the last one
  std::size_t ghosts = 0, given_back = 0;
};

// to += share * more, number by number; the report becomes that of `more`.
void add_share(const AloneScore& more, double share, AloneScore* to);
void add_share(const RestScore& more, double share, RestScore* to);
void add_share(const CutoutScore& more, double share, CutoutScore* to);

}  // namespace splatcut
