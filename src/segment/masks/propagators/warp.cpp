// The nearest view's mask through the depth of both. The warp with its z-test is ours; kLift is measured
// against it.
#include <cmath>

#include "segment/masks/propagate.h"

namespace splatcut {

Mask warped_by_depth(const SeenView& from, const Camera& to, const Image<float>& to_depth, float tolerance) {
  Mask mask(to.width_px, to.height_px);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      const float z = to_depth.at(x, y);
      if (z <= 0) continue;
      const glm::vec3 there = from.camera.camera_from_world(to.world_from_pixel(glm::vec2(x, y) + 0.5f, z));
      if (there.z <= 0) continue;
      const glm::vec2 pixel = glm::floor(from.camera.pixel_from_camera(there));
      if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < 32768 && pixel.y < 32768)) continue;
      const int u = static_cast<int>(pixel.x), v = static_cast<int>(pixel.y);
      if (!from.mask.contains(u, v)) continue;
      if (std::abs(from.depth.at(u, v) - there.z) <= tolerance * there.z) mask.at(x, y) = from.mask.at(u, v);
    }
  return mask;
}

constinit const Propagator Propagator::kWarp = {
    .name = "warp",
    .sentence = "masks through depth",
    .of_pictures = true,
    .mask = [](const OpenView& view) { return warped_by_depth(nearest(view), view.camera, view.depth); },
};

}  // namespace splatcut
