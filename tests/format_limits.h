// How far each format may be from what was written into it.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/cloud/quantise.h"
#include "scene_file_helpers.h"

namespace splatcut::testing {

// 1 - |dot| of two rotations whose smallest three components differ by up to e: the largest is at least 1/2,
// so it differs by up to 3 e, and 1 - dot is half the squared distance.
inline float rotation_limit(float e) {
  return 6 * e * e + 1e-6f;
}

// Of varied_cloud(): positions -5 to 5, logarithms of scales over 2, f_dc over 2, SH over 1.8. Half a step of
// each quantisation, and a hundredth of it for rounding.
struct FormatLimits {
  Tolerance limit;
  bool reorders = false;  // rows are in Morton order
  bool drops_sh = false;
};
inline const std::map<std::string, FormatLimits>& limits() {
  constexpr float kByte = 0.505f / 255, kRoot = 1.41421356f;
  static const std::map<std::string, FormatLimits> table = {
      {"ply", {{0, 1e-5f, 1e-6f, 1e-6f, 0, 0}}},
      {"glb", {{0, 1e-6f, 1e-6f, 0, 0, 0}}},
      {"compressed.ply",
       {{10 * 0.505f / 1023, 2 * 0.505f / 1023, rotation_limit(0.5f * kRoot / 1023), kByte, 2 * kByte,
         0.505f * 8 / 256},
        true}},
      {"splat", {{0, 1e-6f, rotation_limit(1.0f / 128), kByte, kByte / kShC0Rounded, 0}, false, true}},
      {"spz",
       {{0.505f / 4096, 0.505f / 16, rotation_limit(0.5f / kRoot / 511), kByte, kByte / 0.15f,
         0.505f / 128}}},
      // 16 bits of log(1 + |x|), which is stretched by 1 + |x|. Codebooks of evenly spread values have steps
      // alike; twice half a step leaves room for uneven samples.
      {"sog",
       {{6 * 2 * std::log(6.0f) * 0.51f / 65535, 2 * 1.0f / 256, rotation_limit(1 / kRoot / 255), kByte,
         2 * 1.0f / 256, 1.8f * 1.0f / 256},
        true}},
  };
  return table;
}

// The cloud in the order in which a format writes the scene's rows.
inline GaussianCloud as_written(const Scene& scene, bool reorders) {
  std::vector<std::uint32_t> order(scene.cloud.size());
  for (std::uint32_t g = 0; g < order.size(); ++g) order[reorders ? g : scene.cloud.file_row[g]] = g;
  return permuted(scene.cloud, order);
}

}  // namespace splatcut::testing
