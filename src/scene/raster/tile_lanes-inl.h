// Blocks of pixels as SIMD lanes, and the arithmetic on them that gives the same bits on every target.
// Compiled once per SIMD target, within tile_blend.cpp, hence the guard that each target turns round.
#if defined(SPLATCUT_TILE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATCUT_TILE_LANES_INL_H
#undef SPLATCUT_TILE_LANES_INL_H
#else
#define SPLATCUT_TILE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>

#include "scene/raster/tile_grid.h"

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBlockPx = 4;  // blocks of 4x4 pixels keep their state in registers
constexpr int kBlockPixels = kBlockPx * kBlockPx;
constexpr int kBlocksAcross = kTilePx / kBlockPx;
constexpr int kBlocks = kBlocksAcross * kBlocksAcross;
constexpr int kTilePixels = kTilePx * kTilePx;

using Lanes = hn::CappedTag<float, kBlockPixels>;
using IntLanes = hn::RebindToSigned<Lanes>;
using V = hn::Vec<Lanes>;
constexpr Lanes kF;
constexpr IntLanes kI;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(kF));
constexpr int kVectors = kBlockPixels / kWidth;
constexpr bool kSameColumns = kWidth % kBlockPx == 0;  // in all vectors of a block

// Pixel centres of a block, from its corner.
alignas(64) constexpr float kCentreX[kBlockPixels] = {0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                                      0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f};
alignas(64) constexpr float kCentreY[kBlockPixels] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f,
                                                      2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f};

// a b + c, rounded once, on every target: what makes all of them give the same bits.
HWY_INLINE V fma(V a, V b, V c) {
#if HWY_NATIVE_FMA
  return hn::MulAdd(a, b, c);
#else
  alignas(64) float x[kWidth], y[kWidth], z[kWidth];
  hn::Store(a, kF, x);
  hn::Store(b, kF, y);
  hn::Store(c, kF, z);
  for (int i = 0; i < kWidth; ++i) z[i] = std::fma(x[i], y[i], z[i]);
  return hn::Load(kF, z);
#endif
}

// Added to a float below 2^22 in size, leaves it rounded to a whole number in the low bits.
constexpr float kRoundShift = 12582912.0f;  // 1.5 * 2^23
constexpr std::int32_t kRoundShiftBits = 0x4b400000;

// 2^p for p <= 0, relative error below 3e-7: integer part into the exponent, Taylor series of degree 6.
HWY_INLINE V exp2_of(V p) {
  p = hn::Max(p, hn::Set(kF, -126.0f));
  const V shifted = hn::Add(p, hn::Set(kF, kRoundShift));
  const V f = hn::Sub(p, hn::Sub(shifted, hn::Set(kF, kRoundShift)));
  V r = hn::Set(kF, 1.5403530e-4f);
  r = fma(r, f, hn::Set(kF, 1.3333558e-3f));
  r = fma(r, f, hn::Set(kF, 9.6181291e-3f));
  r = fma(r, f, hn::Set(kF, 5.5504109e-2f));
  r = fma(r, f, hn::Set(kF, 2.4022651e-1f));
  r = fma(r, f, hn::Set(kF, 6.9314718e-1f));
  r = fma(r, f, hn::Set(kF, 1.0f));
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(kI, shifted));
  return hn::BitCast(kF, hn::Add(hn::BitCast(kI, r), exponent));
}

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#endif  // SPLATCUT_TILE_LANES_INL_H
