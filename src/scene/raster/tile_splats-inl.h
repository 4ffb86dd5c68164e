// The splats of a tile, a chunk at a time, and which of its blocks of pixels each may touch.
// Compiled once per SIMD target, within tile_blend.cpp, hence the guard that each target turns round.
#if defined(SPLATCUT_TILE_SPLATS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATCUT_TILE_SPLATS_INL_H
#undef SPLATCUT_TILE_SPLATS_INL_H
#else
#define SPLATCUT_TILE_SPLATS_INL_H
#endif

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>

#include "scene/raster/splat_math.h"
#include "scene/raster/tile_blend.h"
#include "scene/raster/tile_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

// Splats blended at a time: they and the tile's pixels fit the first-level cache, and what lies behind a tile
// that has become opaque is never looked at.
constexpr int kChunk = 256;

// The splats of a tile that are being blended. The arrays hold whole vectors; what pads them touches no
// block.
struct Chunk {
  static constexpr int kCapacity = kChunk + kBlockPixels;
  int size = 0;
  const BlendSplat* splats = nullptr;  // of the grid, by Gaussian
  std::array<std::uint32_t, kCapacity> gaussian;
  // The ellipse alpha >= 1/255: at height dy it reaches from tilt dy - w to tilt dy + w,
  // w = sqrt(width2 - slope dy^2), and farthest at dy = +-tip.
  alignas(64) std::array<float, kCapacity> x, y, tilt, width2, slope, tip;
  std::array<float, kCapacity> label;         // 0 or 1
  std::array<std::int32_t, kCapacity> group;  // its place in TileGroups, or -1
  // Sums of the tile so far, lane by lane, 2^-16 pixel.
  alignas(64) std::array<std::int32_t, kCapacity * kWidth> total, inside;
  alignas(64) std::array<std::array<std::int32_t, kCapacity * kWidth>, PlaneSums::kMost> plane;
};

// Indices into a chunk, front to back, for each block of a row of blocks.
struct BlockLists {
  alignas(64) std::array<std::array<std::int32_t, Chunk::kCapacity>, kBlocksAcross> splat;
  std::array<int, kBlocksAcross> count;
};

// Reads what TileLists keeps, row of blocks by row of blocks, in the order in which it was written.
struct ListReader {
  const TileLists& lists;
  std::size_t splat = 0, count = 0;  // read so far

  void read_row(std::uint32_t alive, BlockLists* row) {
    for (int b = 0; b < kBlocksAcross; ++b) {
      const int n = lists.count[count++];
      row->count[b] = n;
      if (alive >> b & 1) std::copy_n(lists.splat.data() + splat, n, row->splat[b].data());
      splat += static_cast<std::size_t>(n);
    }
  }
};

inline void write_row(const BlockLists& row, TileLists* lists) {
  static_assert(kChunk <= 256, "places within a chunk fit 8 bits");
  std::size_t at = lists->splat.size();
  lists->splat.resize(at + static_cast<std::size_t>(std::accumulate(row.count.begin(), row.count.end(), 0)));
  for (int b = 0; b < kBlocksAcross; ++b) {
    lists->count.push_back(static_cast<std::uint16_t>(row.count[b]));
    std::uint8_t* to = lists->splat.data() + at;
    for (int k = 0; k < row.count[b]; ++k) to[k] = static_cast<std::uint8_t>(row.splat[b][k]);
    at += static_cast<std::size_t>(row.count[b]);
  }
}

inline void derive_ellipses(Chunk* chunk) {
  // On entry width2, slope and tip hold log2_opacity, qc and qb, and tilt holds qa.
  const V faintest = hn::Set(kF, kLog2AlphaMin - kLog2AlphaSlack),
          tiny = hn::Set(kF, std::numeric_limits<float>::min());
  for (int i = 0; i < chunk->size; i += kWidth) {
    const V qa = hn::Load(kF, &chunk->tilt[i]), qb = hn::Load(kF, &chunk->tip[i]),
            qc = hn::Load(kF, &chunk->slope[i]);
    const V tilt = hn::Div(hn::Mul(hn::Set(kF, -0.5f), qb), qa);
    const V width2 = hn::Div(hn::Sub(faintest, hn::Load(kF, &chunk->width2[i])), qa);
    const V ratio = hn::Div(qc, qa);
    const V slope = hn::Sub(ratio, hn::Mul(tilt, tilt));
    const V tip = hn::Mul(tilt, hn::Sqrt(hn::Div(width2, hn::Max(hn::Mul(slope, ratio), tiny))));
    hn::Store(tilt, kF, &chunk->tilt[i]);
    hn::Store(width2, kF, &chunk->width2[i]);
    hn::Store(slope, kF, &chunk->slope[i]);
    hn::Store(tip, kF, &chunk->tip[i]);
  }
}

// ellipses: what list_row() needs.
inline void gather(const TileBlend& what, const TileEntry* entries, std::span<const std::uint32_t> order,
                   bool ellipses, Chunk* chunk) {
  constexpr int kAhead = 16;  // splats lie apart in memory: asked for early
  const int count = static_cast<int>(order.size());
  const auto gaussian_of = [&](int i) { return entries[order[static_cast<std::size_t>(i)]].gaussian; };
  chunk->size = count;
  chunk->splats = what.grid.splats.data();
  for (int i = 0; i < count; ++i) {
    if (i + kAhead < count) __builtin_prefetch(chunk->splats + gaussian_of(i + kAhead));
    chunk->gaussian[i] = gaussian_of(i);
    if (!ellipses) continue;
    const BlendSplat& s = chunk->splats[chunk->gaussian[i]];
    chunk->x[i] = s.x_px;
    chunk->y[i] = s.y_px;
    chunk->tilt[i] = s.qa;
    chunk->tip[i] = s.qb;
    chunk->slope[i] = s.qc;
    chunk->width2[i] = s.log2_opacity;
  }
  for (int i = count; ellipses && i % kWidth != 0; ++i) {
    chunk->x[i] = chunk->y[i] = chunk->tip[i] = 0;
    chunk->tilt[i] = chunk->slope[i] = -1;
    chunk->width2[i] = -1e9f;
  }
  if (ellipses) derive_ellipses(chunk);
  if (!what.options.labels.empty())
    for (int i = 0; i < count; ++i) chunk->label[i] = what.options.labels[chunk->gaussian[i]] ? 1.0f : 0.0f;
  if (what.pair_sums) {
    std::fill_n(chunk->total.begin(), count * kWidth, 0);
    std::fill_n(chunk->inside.begin(), count * kWidth, 0);
  }
  for (std::size_t k = 0; what.plane_sums && k < what.options.sum_planes.size(); ++k)
    std::fill_n(chunk->plane[k].begin(), count * kWidth, 0);
}

// Lists, for each block of the row of blocks whose corner is (x0, y0), the splats of the chunk that may reach
// alpha 1/255 at one of its pixel centres.
inline void list_row(const Chunk& chunk, float x0, float y0, std::uint32_t alive, BlockLists* lists) {
  constexpr float kFirst = 0.5f, kLast = kBlockPx - 0.5f;  // pixel centres
  constexpr float kSlackPx = 0.05f;                        // rounding of long, thin splats
  lists->count.fill(0);
  const V zero = hn::Zero(kF);
  for (int i = 0; i < chunk.size; i += kWidth) {
    const V x = hn::Load(kF, &chunk.x[i]), y = hn::Load(kF, &chunk.y[i]);
    const V tilt = hn::Load(kF, &chunk.tilt[i]), tip = hn::Load(kF, &chunk.tip[i]);
    const V width2 = hn::Load(kF, &chunk.width2[i]), slope = hn::Load(kF, &chunk.slope[i]);
    const V top = hn::Sub(hn::Set(kF, y0 + kFirst), y), bottom = hn::Sub(hn::Set(kF, y0 + kLast), y);
    const auto clamped = [&](V dy) { return hn::Min(hn::Max(dy, top), bottom); };
    const auto width2_at = [&](V dy) { return hn::Sub(width2, hn::Mul(slope, hn::Mul(dy, dy))); };
    const auto reached = hn::Ge(width2_at(clamped(zero)), zero);
    if (hn::AllFalse(kF, reached)) continue;
    const V high = clamped(tip), low = clamped(hn::Neg(tip));
    const V right = hn::Add(hn::Add(x, hn::Mul(tilt, high)), hn::Sqrt(hn::Max(width2_at(high), zero)));
    const V left = hn::Sub(hn::Add(x, hn::Mul(tilt, low)), hn::Sqrt(hn::Max(width2_at(low), zero)));
    const auto index = hn::Iota(kI, i);
    for (int b = 0; b < kBlocksAcross; ++b) {
      if (!(alive >> b & 1)) continue;
      const float corner = x0 + static_cast<float>(b * kBlockPx);
      const auto touches = hn::And(reached, hn::And(hn::Ge(right, hn::Set(kF, corner + kFirst - kSlackPx)),
                                                    hn::Le(left, hn::Set(kF, corner + kLast + kSlackPx))));
      lists->count[b] += static_cast<int>(hn::CompressStore(index, hn::RebindMask(kI, touches), kI,
                                                            lists->splat[b].data() + lists->count[b]));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#endif  // SPLATCUT_TILE_SPLATS_INL_H
