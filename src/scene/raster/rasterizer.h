// CPU tile rasteriser: pictures of a Gaussian cloud and the masked sums of its blending weights.
//
// In: cloud, camera. Out: per pixel colour, alpha, depth, first-hit id; per Gaussian A_g and M_g.
//   Sigma2  = (J W) Sigma (J W)^T + low_pass I                 [px^2]
//   alpha   = min(0.99, opacity exp(-1/2 d^T Sigma2^-1 d)),    skipped below 1/255
//   weight  = alpha T,   T *= 1 - alpha,                       front to back by camera z, until T < 1e-4
//   A_g     = sum of weight over pixels,  M_g = the same over mask pixels
// Source: Kerbl et al., 3D Gaussian Splatting, 2023; Zwicker et al., EWA splatting, 2001; Jain et al.,
// GaussianCut, NeurIPS 2024, eq. 1-2.
// Cost: linear in Gaussians plus splat-pixel pairs; threads by oneTBB, SIMD by Highway.
// Same input, same bits, on any number of threads and any SIMD width: pixels are independent lanes, FMA
// is explicit, and sums are integers of 2^-16 pixel.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/cloud_blocks.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/splat_math.h"

namespace splatcut {

// What pictures of the camera leave out where their options name no near plane, scene units.
inline float near_plane_for(const GaussianCloud& cloud, const Camera& camera) {
  return std::min(cloud.near_plane, camera.most_near_plane);
}

// A_g and M_g summed over any number of views, in units of 2^-16 pixel.
struct MaskedSums {
  static constexpr double kUnitsPerPixel = 65536.0;
  std::vector<std::int64_t> total;   // A_g
  std::vector<std::int64_t> inside;  // M_g <= A_g
  explicit MaskedSums(std::size_t gaussians = 0) : total(gaussians, 0), inside(gaussians, 0) {}
};

// Sums of weight times the pixel's value on each of a few planes, in units of 2^-16: for moments and means of
// what a Gaussian shows. By Gaussian, then by plane.
struct PlaneSums {
  static constexpr std::size_t kMost = 8;  // planes
  std::vector<std::int64_t> sum;

  PlaneSums(std::size_t gaussians, std::size_t planes) : sum(gaussians * planes, 0), planes_(planes) {}
  double at(std::size_t gaussian, std::size_t plane) const {
    return static_cast<double>(sum[gaussian * planes_ + plane]) / MaskedSums::kUnitsPerPixel;
  }
  std::size_t planes() const { return planes_; }

 private:
  std::size_t planes_;
};

// What a pixel gets from one group of Gaussians, or from one Gaussian: sum of alpha T over them.
struct GroupWeight {
  std::uint32_t group = 0;
  float weight = 0;
};
inline constexpr std::uint32_t kNoGroup = 0xffffffffu;

// The heaviest, where all together cover at least half of the pixel; kNoGroup elsewhere.
std::uint32_t group_of_pixel(std::span<const GroupWeight> heaviest_first);

// One list a pixel. They lie in `memory`, those of a tile together; so this is moved, but never copied.
struct ListedWeights {
  Image<std::span<GroupWeight>> of;
  std::vector<std::vector<GroupWeight>> memory;

  ListedWeights() = default;
  ListedWeights(ListedWeights&&) = default;
  ListedWeights& operator=(ListedWeights&&) = default;
};

struct RasterOptions {
  bool colour = true;
  bool depth = false;  // expected depth, median depth and first-hit id
  glm::vec3 background{0};
  std::optional<float>
      near_plane;  // scene units; Gaussians with camera z below are skipped; empty: near_plane_for()
  float low_pass_px2 = kLowPassPx2;
  std::optional<PixelRect> roi;  // draw these pixels only; outputs have the size of the rectangle
  std::span<const glm::vec3> colour_override;  // size of the cloud: replaces SH colour, >= 0
  std::span<const std::uint8_t> labels;        // size of the cloud, with colour = false: gives label_share
  std::span<const std::uint32_t> groups;       // size of the cloud: gives group
  bool list_gaussians = false;                 // with colour = false: gives gaussians
  float least_listed_weight = 0.02f;           // of a pixel, for those two: less does not count
  std::span<const std::uint8_t> shown;         // size of the cloud: 0 leaves the Gaussian out
  const CloudBlocks* blocks = nullptr;         // of the cloud: runs that the view does not show cost nothing
  const Mask* sum_mask = nullptr;              // with `sums`: size of the camera's picture, non-zero = object
  MaskedSums* sums = nullptr;                  // added to; arrays of the cloud's size
  bool sum_whole_pixels = false;               // a pixel counts 1, not by its weight, where alpha >= 1/255
  std::span<const Image<float>> sum_planes;    // with `plane_sums`, without colour, depth, labels, groups and
                                               // sums: of the size drawn, values in [-1, 1]
  PlaneSums* plane_sums = nullptr;             // added to
  std::size_t most_pairs =
      std::size_t{1}
      << 26;  // listed at once, 24 bytes each; more are drawn region by region, to the same bits
};

struct RasterOutput {
  Image<glm::vec3> colour;        // over the background, >= 0, not clamped above
  Image<float> alpha;             // 1 - T
  Image<float> label_share;       // sum of weight over Gaussians with a label other than 0
  Image<std::uint32_t> group;     // group_of_pixel()
  ListedWeights gaussians;        // front to back; of over 48 the heaviest, in any order
  Image<float> expected_depth;    // sum(weight z) / sum(weight), camera z in scene units; 0 where nothing is
  Image<float> median_depth;      // camera z of the Gaussian at which T falls below 0.5; 0 where none does
  Image<std::int32_t> first_hit;  // that Gaussian's index in the cloud, or -1
};

RasterOutput rasterize(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options = {},
                       const Job& job = {});

}  // namespace splatcut
