// What reader and writer of .sog share. Internal to src/scene/formats.
//
// Pictures of 8 bits, a pixel for each Gaussian, row by row, and meta.json, which names them; together in a
// ZIP, or side by side in a folder (then meta.json is the scene).
//   means_l, means_u   low and high bytes of 16 bits between mins and maxs; what they stand for is
//                      sign(x) log(1 + |x|)
//   quats              the three components that are not the largest, of w x y z, times sqrt(2), -1 to 1;
//                      alpha - 252 is the number of the largest
//   scales, sh0        numbers of entries in a codebook of 256: the logarithms of scales, f_dc;
//                      alpha of sh0 is the opacity
//   shN_labels         16-bit number of a row of shN_centroids, which has 64 rows side by side, a pixel for
//                      each coefficient, and holds numbers of entries in a codebook
// Version 1 has ranges instead of codebooks, and opacities as logits. Axes are those of .ply.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "scene/formats/scene_file.h"

namespace splatcut {

namespace sog {
constexpr int kLargestAt = 252;
constexpr std::size_t kCentroidsPerRow = 64;
constexpr float kSteps = 65535.0f;

inline float to_log(float v) {
  return v < 0 ? -std::log1p(-v) : std::log1p(v);
}
inline float from_log(float v) {
  return v < 0 ? -std::expm1(-v) : std::expm1(v);
}
}  // namespace sog

std::string write_sog(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options);
FormatPlan plan_sog(const Scene& scene, std::span<const std::uint32_t> gaussians, bool moved);

}  // namespace splatcut
