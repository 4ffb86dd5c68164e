#include "segment/graphcut/overlap_weights.h"

#include <bit>
#include <cstdint>
#include <limits>

// The compiler makes a second version for AVX2 and chooses at load time. Sanitizers do not survive that.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define SPLATCUT_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define SPLATCUT_WIDE_VECTORS
#endif

namespace splatcut {

namespace {

constexpr float kLog2E = 1.4426950408889634f, kLn2 = 0.6931471805599453f;
constexpr float kLeastArea = 1e-38f;  // scene units squared: 2 over less is infinite
constexpr float kRidge = 1e-3f;       // of S's trace, added to all three matrices: flat splats have a volume

// log2 of a normal v > 0: v = 2^e m with m in [sqrt(1/2), sqrt(2)), ln m = 2 atanh((m - 1) / (m + 1)) by its
// series.
inline __attribute__((always_inline)) float log2_of(float v) {
  constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3, kMantissaBits = 23, kMantissaMask = 0x007fffff;
  const std::int32_t shifted = std::bit_cast<std::int32_t>(v) - kSqrtHalfBits;
  const auto exponent = static_cast<float>(shifted >> kMantissaBits);
  const float m = std::bit_cast<float>((shifted & kMantissaMask) + kSqrtHalfBits);
  const float s = (m - 1) / (m + 1), s2 = s * s;
  constexpr float k = 2 * kLog2E;
  return exponent + ((((k / 9 * s2 + k / 7) * s2 + k / 5) * s2 + k / 3) * s2 + k) * s;
}

// 2^p for p in [-126, 1]: the integer part into the exponent, a Taylor series for the rest.
inline __attribute__((always_inline)) float exp2_of(float p) {
  constexpr float kRoundShift =
      12582912.0f;  // 1.5 * 2^23: leaves a small float rounded to a whole number in its low bits
  p = p > -126.0f ? p : -126.0f;
  const float shifted = p + kRoundShift, f = (p - (shifted - kRoundShift)) * kLn2;
  const float r = (((((f / 720 + 1.0f / 120) * f + 1.0f / 24) * f + 1.0f / 6) * f + 0.5f) * f + 1) * f + 1;
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(r) + (std::bit_cast<std::int32_t>(shifted) << 23));
}

inline __attribute__((always_inline)) float determinant(float xx, float xy, float xz, float yy, float yz,
                                                        float zz) {
  return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
}

}  // namespace

void OverlapBlock::set(int pair, const Symmetric3& g, const Symmetric3& h, const glm::vec3& difference,
                       float unlikeness) {
  const float of_g[6] = {g.xx, g.xy, g.xz, g.yy, g.yz, g.zz}, of_h[6] = {h.xx, h.xy, h.xz, h.yy, h.yz, h.zz};
  for (int i = 0; i < 6; ++i) {
    a[i][pair] = of_g[i];
    b[i][pair] = of_h[i];
  }
  for (int i = 0; i < 3; ++i) d[i][pair] = difference[i];
  unlike[pair] = unlikeness;
}

SPLATCUT_WIDE_VECTORS void overlap_weights(OverlapBlock& block, float gamma_position) {
  for (int i = 0; i < OverlapBlock::kPairs; ++i) {
    const float trace2 =
        block.a[0][i] + block.a[3][i] + block.a[5][i] + block.b[0][i] + block.b[3][i] + block.b[5][i];
    // Scaled to S of unit trace: determinants of tiny scenes stay in range, and D does not change. Of two
    // points the squared distance stands in its place: D is 250 in any unit, and 0 at one place.
    const float dx = block.d[0][i], dy = block.d[1][i], dz = block.d[2][i];
    const float apart2 = dx * dx + dy * dy + dz * dz;
    const float of_points = apart2 > kLeastArea ? 1.0f / apart2 : 1.0f;
    const float unit = trace2 > kLeastArea ? 2.0f / trace2 : of_points;
    const float axx = block.a[0][i] * unit, axy = block.a[1][i] * unit, axz = block.a[2][i] * unit;
    const float ayy = block.a[3][i] * unit, ayz = block.a[4][i] * unit, azz = block.a[5][i] * unit;
    const float bxx = block.b[0][i] * unit, bxy = block.b[1][i] * unit, bxz = block.b[2][i] * unit;
    const float byy = block.b[3][i] * unit, byz = block.b[4][i] * unit, bzz = block.b[5][i] * unit;
    const float sxx = 0.5f * (axx + bxx) + kRidge, sxy = 0.5f * (axy + bxy), sxz = 0.5f * (axz + bxz);
    const float syy = 0.5f * (ayy + byy) + kRidge, syz = 0.5f * (ayz + byz),
                szz = 0.5f * (azz + bzz) + kRidge;
    const float det_a = determinant(axx + kRidge, axy, axz, ayy + kRidge, ayz, azz + kRidge);
    const float det_b = determinant(bxx + kRidge, bxy, bxz, byy + kRidge, byz, bzz + kRidge);
    const float det_s = determinant(sxx, sxy, sxz, syy, syz, szz);
    const float x = block.d[0][i], y = block.d[1][i], z = block.d[2][i];
    // d^T adj(S) d
    const float form = x * x * (syy * szz - syz * syz) + y * y * (sxx * szz - sxz * sxz) +
                       z * z * (sxx * syy - sxy * sxy) +
                       2 * (x * y * (sxz * syz - sxy * szz) + x * z * (sxy * syz - sxz * syy) +
                            y * z * (sxy * sxz - sxx * syz));
    constexpr float kLeast =
        1e-12f;  // a thousandth of the ridge's own determinant: rounding may not make a sign
    const float s = det_s > kLeast ? det_s : kLeast, a = det_a > kLeast ? det_a : kLeast,
                b = det_b > kLeast ? det_b : kLeast;
    const float mahalanobis2 = unit * form / s;
    const float distance = 0.25f * mahalanobis2 + kLn2 * (log2_of(s) - 0.5f * (log2_of(a) + log2_of(b)));
    const float all = det_a + det_b + det_s + mahalanobis2 + block.unlike[i];
    const bool finite = all - all == 0;
    block.distance[i] = finite ? distance : std::numeric_limits<float>::infinity();
    const float psi = exp2_of(-kLog2E * (gamma_position * distance + block.unlike[i]));
    block.psi[i] = finite ? psi : 0.0f;
  }
}

}  // namespace splatcut
