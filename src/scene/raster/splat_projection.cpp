#include "scene/raster/splat_projection.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "scene/raster/splat_math.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scene/raster/splat_projection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using IntLanes = hn::RebindToSigned<Lanes>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
constexpr Lanes kF;
constexpr IntLanes kI;
constexpr std::size_t kWidth = hn::MaxLanes(kF);

constexpr float kLog2E = 1.4426950408889634f;
constexpr float kLn2 = 0.6931471805599453f;
constexpr float kLog2Of255 = 7.994353436858858f;

struct V3 {
  V x, y, z;
};

HWY_INLINE V set(float value) {
  return hn::Set(kF, value);
}
HWY_INLINE V3 set(const glm::vec3& v) {
  return {set(v.x), set(v.y), set(v.z)};
}
HWY_INLINE V sum3(V a, V b, V c) {
  return hn::Add(hn::Add(a, b), c);
}
HWY_INLINE V dot(const V3& a, const V3& b) {
  return sum3(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z));
}
HWY_INLINE V clamp(V v, float low, float high) {
  return hn::Min(hn::Max(v, set(low)), set(high));
}

// log2(v) for normal v > 0, absolute error below 2e-7: v = 2^e m with m in [sqrt(1/2), sqrt(2)), and
// ln m = 2 atanh((m - 1) / (m + 1)) by its series.
HWY_INLINE V log2_of(V v) {
  constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3, kMantissaBits = 23, kMantissaMask = 0x007fffff;
  const auto shifted = hn::Sub(hn::BitCast(kI, v), hn::Set(kI, kSqrtHalfBits));
  const V exponent = hn::ConvertTo(kF, hn::ShiftRight<kMantissaBits>(shifted));
  const V m =
      hn::BitCast(kF, hn::Add(hn::And(shifted, hn::Set(kI, kMantissaMask)), hn::Set(kI, kSqrtHalfBits)));
  const V s = hn::Div(hn::Sub(m, set(1)), hn::Add(m, set(1)));
  const V s2 = hn::Mul(s, s);
  V series = set(2 * kLog2E / 9);
  for (const float odd : {7.0f, 5.0f, 3.0f, 1.0f})
    series = hn::Add(hn::Mul(series, s2), set(2 * kLog2E / odd));
  return hn::Add(exponent, hn::Mul(series, s));
}

// The attributes of kWidth Gaussians that projection reads.
struct Attributes {
  V3 position, scale;
  V qx, qy, qz, qw;
  V opacity;
};

static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(glm::quat) == 4 * sizeof(float));

HWY_INLINE Attributes load(const glm::vec3* position, const glm::vec3* scale, const glm::quat* rotation,
                           const float* opacity) {
  Attributes a;
  hn::LoadInterleaved3(kF, &position->x, a.position.x, a.position.y, a.position.z);
  hn::LoadInterleaved3(kF, &scale->x, a.scale.x, a.scale.y, a.scale.z);
  hn::LoadInterleaved4(kF, &rotation->x, a.qx, a.qy, a.qz, a.qw);  // GLM keeps x y z w
  a.opacity = hn::LoadU(kF, opacity);
  return a;
}

// The last Gaussians of the cloud, fewer than a vector: the rest is padded with Gaussians of opacity 0.
HWY_INLINE Attributes load_tail(const GaussianCloud& cloud, std::uint32_t g, std::size_t count) {
  glm::vec3 position[kWidth]{}, scale[kWidth]{};
  glm::quat rotation[kWidth]{};
  float opacity[kWidth]{};
  std::copy_n(cloud.position.data() + g, count, position);
  std::copy_n(cloud.scale.data() + g, count, scale);
  std::copy_n(cloud.rotation.data() + g, count, rotation);
  std::copy_n(cloud.opacity.data() + g, count, opacity);
  return load(position, scale, rotation, opacity);
}

// (R diag(s))^T v: the vector seen along the local axes, each in units of its standard deviation.
HWY_INLINE V3 scaled_to_local(const Attributes& a, const V3& v) {
  const V one = set(1), two = set(2);
  const auto twice = [&](V p, V q) { return hn::Mul(two, hn::Mul(p, q)); };
  const V xx = twice(a.qx, a.qx), yy = twice(a.qy, a.qy), zz = twice(a.qz, a.qz);
  const V xy = twice(a.qx, a.qy), xz = twice(a.qx, a.qz), yz = twice(a.qy, a.qz);
  const V wx = twice(a.qw, a.qx), wy = twice(a.qw, a.qy), wz = twice(a.qw, a.qz);
  const V3 axis_x{hn::Sub(one, hn::Add(yy, zz)), hn::Add(xy, wz), hn::Sub(xz, wy)};
  const V3 axis_y{hn::Sub(xy, wz), hn::Sub(one, hn::Add(xx, zz)), hn::Add(yz, wx)};
  const V3 axis_z{hn::Add(xz, wy), hn::Sub(yz, wx), hn::Sub(one, hn::Add(xx, yy))};
  return {hn::Mul(a.scale.x, dot(axis_x, v)), hn::Mul(a.scale.y, dot(axis_y, v)),
          hn::Mul(a.scale.z, dot(axis_z, v))};
}

// What one view means for all Gaussians.
struct Frame {
  const Camera& camera;
  glm::vec3 right, down, forward;  // camera axes in the world
  glm::vec3 eye_world;
  float limit_x, limit_y;  // of x/z and y/z in the Jacobian
  float reach_x, reach_y;  // at most so many times focal length / z and the longest axis from the mean
  float low_pass_px2, low_pass_reach_px;
  float near_plane;
  bool antialiased;
  PixelRect region;
};

Frame frame_of(const Camera& camera, float near_plane, bool antialiased, float low_pass_px2,
               const PixelRect& region) {
  const glm::mat3 world_from_camera = glm::transpose(camera.camera_from_world_rotation);
  const float limit_x = kFrustumSlack * 0.5f * static_cast<float>(camera.width_px) / camera.fx_px;
  const float limit_y = kFrustumSlack * 0.5f * static_cast<float>(camera.height_px) / camera.fy_px;
  return {camera,
          world_from_camera[0],
          world_from_camera[1],
          world_from_camera[2],
          camera.centre_world(),
          limit_x,
          limit_y,
          kCutoffSigmas * std::sqrt(1 + limit_x * limit_x),
          kCutoffSigmas * std::sqrt(1 + limit_y * limit_y),
          low_pass_px2,
          kCutoffSigmas * std::sqrt(low_pass_px2),
          near_plane,
          antialiased,
          region};
}

// sqrt(det sharp / det blurred), as splat_math.h has it for one.
HWY_INLINE V antialiased_share(V sharp_xx, V sharp_xy, V sharp_yy, V det_blurred) {
  const V det_sharp = hn::Sub(hn::Mul(sharp_xx, sharp_yy), hn::Mul(sharp_xy, sharp_xy));
  return hn::Sqrt(hn::Div(hn::Max(det_sharp, hn::Zero(kF)), det_blurred));
}

HWY_INLINE M overlaps(V centre, V half, int low, int high) {
  return hn::And(hn::Ge(hn::Add(centre, half), set(static_cast<float>(low))),
                 hn::Le(hn::Sub(centre, half), set(static_cast<float>(high))));
}

// Projects kWidth Gaussians, of which `wanted` count, and appends those that touch the region.
HWY_INLINE void project_vector(const Attributes& a, M wanted, std::uint32_t first, const Frame& frame,
                               SplatBatch* batch) {
  const Camera& camera = frame.camera;
  const glm::vec3& t = camera.camera_from_world_translation;
  const V3 right = set(frame.right), down = set(frame.down), forward = set(frame.forward);
  const V z = hn::Add(dot(forward, a.position), set(t.z));
  const M before =
      hn::And(wanted, hn::And(hn::Ge(z, set(frame.near_plane)), hn::Ge(a.opacity, set(kAlphaMin))));
  if (hn::AllFalse(kF, before)) return;
  const V inverse_z = hn::Div(set(1), z);
  const V slope_x = hn::Mul(hn::Add(dot(right, a.position), set(t.x)), inverse_z);
  const V slope_y = hn::Mul(hn::Add(dot(down, a.position), set(t.y)), inverse_z);

  const V pixels_x = hn::Mul(set(camera.fx_px), inverse_z), pixels_y = hn::Mul(set(camera.fy_px), inverse_z);
  const V x = hn::Add(hn::Mul(set(camera.fx_px), slope_x), set(camera.cx_px));
  const V y = hn::Add(hn::Mul(set(camera.fy_px), slope_y), set(camera.cy_px));
  // Neighbours in space are neighbours in the cloud: mostly all of a vector lie far from a small region. No
  // splat reaches farther than sqrt(2 ln 255) of its longest axis, seen at full length, and of the low-pass.
  const V longest = hn::Max(hn::Max(a.scale.x, a.scale.y), a.scale.z);
  const V reach_x = hn::MulAdd(hn::Mul(longest, pixels_x), set(frame.reach_x), set(frame.low_pass_reach_px));
  const V reach_y = hn::MulAdd(hn::Mul(longest, pixels_y), set(frame.reach_y), set(frame.low_pass_reach_px));
  const M near = hn::And(overlaps(x, reach_x, frame.region.x0, frame.region.x1),
                         overlaps(y, reach_y, frame.region.y0, frame.region.y1));
  if (hn::AllFalse(kF, hn::And(before, near))) return;

  // Rows of J W in the world frame; Sigma2 = (J W) R diag(s^2) R^T (J W)^T.
  const V bend_x = clamp(slope_x, -frame.limit_x, frame.limit_x),
          bend_y = clamp(slope_y, -frame.limit_y, frame.limit_y);
  const auto row = [&](V pixels, const V3& axis, V bend) {
    const auto component = [&](V along, V ahead) {
      return hn::Mul(pixels, hn::Sub(along, hn::Mul(bend, ahead)));
    };
    return V3{component(axis.x, forward.x), component(axis.y, forward.y), component(axis.z, forward.z)};
  };
  const V3 u = scaled_to_local(a, row(pixels_x, right, bend_x)),
           v = scaled_to_local(a, row(pixels_y, down, bend_y));
  const V sharp_xx = dot(u, u), sharp_yy = dot(v, v), sigma_xy = dot(u, v);
  const V sigma_xx = hn::Add(sharp_xx, set(frame.low_pass_px2)),
          sigma_yy = hn::Add(sharp_yy, set(frame.low_pass_px2));
  const V det = hn::Sub(hn::Mul(sigma_xx, sigma_yy), hn::Mul(sigma_xy, sigma_xy));

  // Below 1/255 nothing is drawn: the least keeps the logarithm of numbers that are.
  const V opacity =
      frame.antialiased
          ? hn::Max(hn::Mul(a.opacity, antialiased_share(sharp_xx, sigma_xy, sharp_yy, det)), set(1e-6f))
          : a.opacity;
  const V log2_opacity = log2_of(opacity);
  const V mahalanobis2 =
      hn::Mul(set(2 * kLn2), hn::Max(hn::Add(log2_opacity, set(kLog2Of255)), hn::Zero(kF)));
  const V half_width = hn::Sqrt(hn::Mul(mahalanobis2, sigma_xx)),
          half_height = hn::Sqrt(hn::Mul(mahalanobis2, sigma_yy));
  const M regular =
      hn::And(hn::Gt(det, hn::Zero(kF)), hn::Lt(det, set(std::numeric_limits<float>::infinity())));
  const M inside = hn::And(overlaps(x, half_width, frame.region.x0, frame.region.x1),
                           overlaps(y, half_height, frame.region.y0, frame.region.y1));
  const M bright = hn::Ge(opacity, set(kAlphaMin));
  const M drawn = hn::And(hn::And(before, bright), hn::And(regular, inside));

  const V scale = hn::Div(set(kLog2E), det);
  const V3 ray = {hn::Sub(a.position.x, set(frame.eye_world.x)),
                  hn::Sub(a.position.y, set(frame.eye_world.y)),
                  hn::Sub(a.position.z, set(frame.eye_world.z))};
  const V inverse_length = hn::Div(set(1), hn::Sqrt(dot(ray, ray)));
  const int at = batch->size;
  const auto keep = [&](V value, float* to) { hn::CompressStore(value, drawn, kF, to + at); };
  keep(x, batch->x_px);
  keep(y, batch->y_px);
  keep(hn::Mul(set(-0.5f), hn::Mul(sigma_yy, scale)), batch->qa);
  keep(hn::Mul(sigma_xy, scale), batch->qb);
  keep(hn::Mul(set(-0.5f), hn::Mul(sigma_xx, scale)), batch->qc);
  keep(log2_opacity, batch->log2_opacity);
  keep(half_width, batch->half_width_px);
  keep(half_height, batch->half_height_px);
  keep(z, batch->depth);
  keep(hn::Mul(ray.x, inverse_length), batch->direction_x);
  keep(hn::Mul(ray.y, inverse_length), batch->direction_y);
  keep(hn::Mul(ray.z, inverse_length), batch->direction_z);
  const auto index = hn::Iota(kI, static_cast<std::int32_t>(first));
  batch->size += static_cast<int>(hn::CompressStore(index, hn::RebindMask(kI, drawn), kI,
                                                    reinterpret_cast<std::int32_t*>(batch->gaussian) + at));
}

// sum of basis[k] rest[k] in four partial sums: an order that vectorises and is the same on every target.
template <int kCoefficients>
HWY_INLINE float sh_sum(const float* basis, const float* rest) {
  float part[4]{};
  int k = 0;
  for (; k + 4 <= kCoefficients; k += 4)
    for (int j = 0; j < 4; ++j) part[j] += basis[k + j] * rest[k + j];
  for (int j = 0; k + j < kCoefficients; ++j) part[j] += basis[k + j] * rest[k + j];
  return (part[0] + part[1]) + (part[2] + part[3]);
}

// Adds the view-dependent part of the SH to the colour of every splat of the batch.
template <int kDegree>
void add_sh(const GaussianCloud& cloud, SplatBatch* batch) {
  constexpr int kCoefficients = sh_rest_coefficients(kDegree);
  float* const colour[3] = {batch->red, batch->green, batch->blue};
  for (int i = 0; i < batch->size; ++i) {
    float basis[15];
    sh_rest_basis(kDegree, {batch->direction_x[i], batch->direction_y[i], batch->direction_z[i]}, basis);
    const float* rest = cloud.sh_rest.data() + std::size_t{batch->gaussian[i]} * 3 * kCoefficients;
    for (int c = 0; c < 3; ++c) colour[c][i] += sh_sum<kCoefficients>(basis, rest + c * kCoefficients);
  }
}

void set_colours(const GaussianCloud& cloud, const RasterOptions& options, SplatBatch* batch) {
  if (!options.colour_override.empty()) {
    for (int i = 0; i < batch->size; ++i) {
      const glm::vec3& colour = options.colour_override[batch->gaussian[i]];
      batch->red[i] = colour.r, batch->green[i] = colour.g, batch->blue[i] = colour.b;
    }
    return;
  }
  if (!options.colour) return;
  for (int i = 0; i < batch->size; ++i) {
    const glm::vec3& dc = cloud.f_dc[batch->gaussian[i]];
    batch->red[i] = 0.5f + kShC0 * dc.r, batch->green[i] = 0.5f + kShC0 * dc.g,
    batch->blue[i] = 0.5f + kShC0 * dc.b;
  }
  if (cloud.sh_degree == 1) add_sh<1>(cloud, batch);
  if (cloud.sh_degree == 2) add_sh<2>(cloud, batch);
  if (cloud.sh_degree == 3) add_sh<3>(cloud, batch);
  for (float* colour : {batch->red, batch->green, batch->blue})
    for (int i = 0; i < batch->size; ++i) colour[i] = std::max(colour[i], 0.0f);
}

// Lanes whose Gaussian is shown.
HWY_INLINE M shown_lanes(const RasterOptions& options, std::uint32_t g, std::size_t count) {
  if (options.shown.empty()) return hn::FirstN(kF, count);
  alignas(64) float shown[kWidth]{};
  for (std::size_t i = 0; i < count; ++i) shown[i] = options.shown[g + i] ? 1.0f : 0.0f;
  return hn::Gt(hn::Load(kF, shown), hn::Zero(kF));
}

void project_batch(const GaussianCloud& cloud, std::uint32_t begin, std::uint32_t end, const Camera& camera,
                   const RasterOptions& options, const PixelRect& region, SplatBatch* batch) {
  const Frame frame = frame_of(camera, options.near_plane.value_or(near_plane_for(cloud, camera)),
                               cloud.antialiased, options.low_pass_px2, region);
  batch->size = 0;
  for (std::uint32_t g = begin; g < end; g += static_cast<std::uint32_t>(kWidth)) {
    const std::size_t count = std::min<std::size_t>(kWidth, end - g);
    const M wanted = shown_lanes(options, g, count);
    if (hn::AllFalse(kF, wanted)) continue;
    const bool whole = g + kWidth <= cloud.size();
    const Attributes a =
        whole ? load(&cloud.position[g], &cloud.scale[g], &cloud.rotation[g], &cloud.opacity[g])
              : load_tail(cloud, g, count);
    project_vector(a, wanted, g, frame, batch);
  }
  set_colours(cloud, options, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatcut {

HWY_EXPORT(project_batch);

void project_batch(const GaussianCloud& cloud, std::uint32_t begin, std::uint32_t end, const Camera& camera,
                   const RasterOptions& options, const PixelRect& region, SplatBatch* batch) {
  assert(begin <= end && end - begin <= SplatBatch::kGaussians && end <= cloud.size());
  HWY_DYNAMIC_DISPATCH(project_batch)(cloud, begin, end, camera, options, region, batch);
}

}  // namespace splatcut
#endif
