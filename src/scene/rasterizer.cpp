#include "scene/rasterizer.h"

#include "scene/grid_drawing.h"
#include "scene/tile_blend.h"

namespace splatcut {

RasterOutput rasterize(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                       const Job& job) {
  const PixelRect roi = drawn_region(cloud, camera, options);
  if (roi.empty()) return empty_output(options, roi);
  const TileGrid grid = bin_splats(cloud, camera, options, job);
  if (job.cancelled()) return empty_output(options, roi);
  return draw_grid(grid, roi, options, job);
}

const char* rasterizer_simd_target() {
  return blend_simd_target();
}

}  // namespace splatcut
