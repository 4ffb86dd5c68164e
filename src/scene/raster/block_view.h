// Which runs of Gaussians a view may show, by the run's bounds alone.
//
// In: a view, a run's box of centres and its longest sigma. Out: false only where project_batch() would list
// none of the run's splats, so that leaving the run out changes no bit of the picture. A splat of longest
// sigma s at camera position (X, Y, Z), Z >= near, reaches no farther than
//   k s fx / Z + k low_pass   pixels to either side of   fx X / Z + cx,   k = 3.4 sqrt(1 + limit^2),
// so that it lies left of a pixel column x0 where fx X + k s fx < (x0 - cx - k low_pass) Z: a half-space,
// which a box is outside of where its nearest corner is.
#pragma once

#include "scene/cloud/cloud_blocks.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

class BlockView {
 public:
  BlockView(const Camera& camera, float near_plane, float low_pass_px2, const PixelRect& region);

  bool may_show(const CloudBlock& block) const;

 private:
  // Points p for which dot(normal, p) + per_sigma s + constant < 0 are not shown.
  struct Side {
    glm::dvec3 normal_world;
    double constant, per_sigma;
  };
  Side sides_[5];  // near, left, right, above, below
};

}  // namespace splatcut
