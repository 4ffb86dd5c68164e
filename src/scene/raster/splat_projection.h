// Projection of many Gaussians at once: what project() and sh_colour() of splat_math.h do to one, by SIMD.
//
// In: a run of Gaussians, a view. Out: the splats that touch the region drawn, in cloud order, with the
// conic in the form that blending wants:
//   alpha(dx, dy) = min(0.99, 2^(log2_opacity + qa dx^2 + qb dx dy + qc dy^2)),   dx, dy from the mean, px
// Same bits on every SIMD target: only +, -, *, / and sqrt, which are rounded exactly, and no FMA.
// Agrees with project() and sh_colour() to rounding.
#pragma once

#include <cstdint>

#include "scene/raster/rasterizer.h"

namespace splatcut {

inline constexpr float kCutoffSigmas =
    3.4f;  // a little more than sqrt(2 ln 255): beyond it alpha is below 1/255

struct SplatBatch {
  static constexpr std::size_t kGaussians = 256;             // that project_batch() takes at most
  static constexpr std::size_t kCapacity = kGaussians + 16;  // room for the last whole vector

  int size = 0;
  alignas(64) std::uint32_t gaussian[kCapacity];
  alignas(64) float x_px[kCapacity], y_px[kCapacity];
  alignas(64) float qa[kCapacity], qb[kCapacity], qc[kCapacity];
  alignas(64) float log2_opacity[kCapacity];
  alignas(64) float half_width_px[kCapacity], half_height_px[kCapacity];  // of the box where alpha >= 1/255
  alignas(64) float depth[kCapacity];                                     // camera z, scene units
  alignas(64) float red[kCapacity], green[kCapacity], blue[kCapacity];
  alignas(64) float direction_x[kCapacity], direction_y[kCapacity], direction_z[kCapacity];  // unit, world
};

// Gaussians begin <= g < end, at most SplatBatch::kGaussians. region: pixels drawn. Colours are those of
// options.colour_override, else of the SH; untouched where neither is wanted.
void project_batch(const GaussianCloud& cloud, std::uint32_t begin, std::uint32_t end, const Camera& camera,
                   const RasterOptions& options, const PixelRect& region, SplatBatch* batch);

}  // namespace splatcut
