#include "scene/raster/tile_blend.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "scene/raster/splat_math.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scene/raster/tile_blend.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBlockPx = 4;  // blocks of 4x4 pixels keep their state in registers
constexpr int kBlockPixels = kBlockPx * kBlockPx;
constexpr int kBlocksAcross = kTilePx / kBlockPx;
constexpr int kBlocks = kBlocksAcross * kBlocksAcross;
constexpr int kTilePixels = kTilePx * kTilePx;

// Splats blended at a time: they and the tile's pixels fit the first-level cache, and what lies behind a tile
// that has become opaque is never looked at.
constexpr int kChunk = 256;

// What is summed up per pixel beside the transmittance.
enum class Paint { kNone, kLabel, kColour, kGroups };

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
  std::array<float, kCapacity> label;  // 0 or 1
  std::array<std::uint32_t, kCapacity> group;
  // Sums of the tile so far, lane by lane, 2^-16 pixel.
  alignas(64) std::array<std::int32_t, kCapacity * kWidth> total, inside;
};

// The pixels of a tile, block by block, row by row within a block.
struct TilePixels {
  alignas(64) std::array<float, kTilePixels> transmittance, red, green, blue, depth, median;
  alignas(64) std::array<std::int32_t, kTilePixels> hit;
  alignas(64) std::array<std::int32_t, kTilePixels> object;  // -1 inside the mask, else 0
  std::array<int, kBlocks> object_pixels;
  bool whole_pixels = false;  // sums count pixels, not weights
  std::uint32_t alive = 0;    // bit b: some pixel of block b can still change
};

// Indices into a chunk, front to back, for each block of a row of blocks.
struct BlockLists {
  alignas(64) std::array<std::array<std::int32_t, Chunk::kCapacity>, kBlocksAcross> splat;
  std::array<int, kBlocksAcross> count;
};

// What each pixel of a tile has got from each group so far, groups in the order in which they were met.
struct TileGroups {
  static constexpr int kMost = 48;  // of a pixel; further ones take the place of the least
  std::array<std::array<GroupWeight, kMost>, kTilePixels> of;
  std::array<int, kTilePixels> count;

  void add(int pixel, std::uint32_t group, float weight) {
    auto& list = of[static_cast<std::size_t>(pixel)];
    int& n = count[static_cast<std::size_t>(pixel)];
    for (int i = n; i-- > 0;)
      if (list[static_cast<std::size_t>(i)].group == group) {
        list[static_cast<std::size_t>(i)].weight += weight;
        return;
      }
    if (n < kMost) {
      list[static_cast<std::size_t>(n++)] = {group, weight};
      return;
    }
    auto least = std::ranges::min_element(list, {}, &GroupWeight::weight);
    if (least->weight < weight) *least = {group, weight};
  }
};

struct Workspace {
  SortSpace sort_space;
  Chunk chunk;
  TileGroups groups;
  TilePixels pixels;
  BlockLists lists;
  TileLists found;  // on their way into TileBlend::lists
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

void write_row(const BlockLists& row, TileLists* lists) {
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

void derive_ellipses(Chunk* chunk) {
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
void gather(const TileBlend& what, const TileEntry* entries, std::span<const std::uint32_t> order,
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
  if (!what.options.groups.empty())
    for (int i = 0; i < count; ++i) chunk->group[i] = what.options.groups[chunk->gaussian[i]];
  if (what.pair_sums) {
    std::fill_n(chunk->total.begin(), count * kWidth, 0);
    std::fill_n(chunk->inside.begin(), count * kWidth, 0);
  }
}

// Lists, for each block of the row of blocks whose corner is (x0, y0), the splats of the chunk that may reach
// alpha 1/255 at one of its pixel centres.
void list_row(const Chunk& chunk, float x0, float y0, std::uint32_t alive, BlockLists* lists) {
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

void start_pixels(const TileBlend& what, int tile_x, int tile_y, TilePixels* pixels) {
  pixels->alive = 0;
  for (auto* values : {&pixels->red, &pixels->green, &pixels->blue, &pixels->depth, &pixels->median})
    values->fill(0);
  pixels->hit.fill(-1);
  pixels->object_pixels.fill(0);
  pixels->whole_pixels = what.options.sum_whole_pixels;
  for (int i = 0; i < kTilePixels; ++i) {
    const int block = i / kBlockPixels, p = i % kBlockPixels;
    const int x = tile_x + block % kBlocksAcross * kBlockPx + p % kBlockPx;
    const int y = tile_y + block / kBlocksAcross * kBlockPx + p / kBlockPx;
    const bool drawn = x >= what.roi.x0 && x < what.roi.x1 && y >= what.roi.y0 && y < what.roi.y1;
    pixels->transmittance[i] =
        drawn ? 1.0f : 0.0f;  // pixels outside are opaque from the start: they do not count
    if (drawn) pixels->alive |= 1u << block;
    if (!what.pair_sums) continue;
    const bool object = drawn && what.options.sum_mask->at(x, y);
    pixels->object[i] = object ? -1 : 0;
    pixels->object_pixels[block] += object;
  }
}

// Blends the listed splats of a chunk into the block with the corner (x0, y0). True when no pixel of it can
// change any more.
template <Paint kPaint, bool kDepth, bool kSums>
bool blend_block(float x0, float y0, int block, const std::int32_t* list, int count, TilePixels* pixels,
                 Chunk* chunk, TileGroups* groups) {
  const int begin = block * kBlockPixels;
  const bool some_object = kSums && pixels->object_pixels[block] != 0,
             whole_pixels = kSums && pixels->whole_pixels;
  V px[kVectors], py[kVectors], transmittance[kVectors], red[kVectors], green[kVectors], blue[kVectors],
      depth[kVectors], median[kVectors];
  hn::Vec<IntLanes> hit[kVectors], object[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    const int at = begin + v * kWidth;
    px[v] = hn::Add(hn::Set(kF, x0), hn::Load(kF, kCentreX + v * kWidth % kBlockPx));
    py[v] = hn::Add(hn::Set(kF, y0), hn::Load(kF, kCentreY + v * kWidth));
    transmittance[v] = hn::Load(kF, &pixels->transmittance[at]);
    if constexpr (kPaint == Paint::kLabel || kPaint == Paint::kColour)
      red[v] = hn::Load(kF, &pixels->red[at]);
    if constexpr (kPaint == Paint::kColour) {
      green[v] = hn::Load(kF, &pixels->green[at]);
      blue[v] = hn::Load(kF, &pixels->blue[at]);
    }
    if constexpr (kDepth) {
      depth[v] = hn::Load(kF, &pixels->depth[at]);
      median[v] = hn::Load(kF, &pixels->median[at]);
      hit[v] = hn::Load(kI, &pixels->hit[at]);
    }
    if constexpr (kSums) object[v] = hn::Load(kI, &pixels->object[at]);
  }
  const V stop = hn::Set(kF, kTransmittanceStop), alpha_min = hn::Set(kF, kAlphaMin),
          alpha_max = hn::Set(kF, kAlphaMax);
  const V half = hn::Set(kF, 0.5f);
  bool opaque = false;
  for (int k = 0; k < count && !opaque; ++k) {
    const int i = list[k];
    const std::uint32_t gaussian = chunk->gaussian[i];
    const BlendSplat& s = chunk->splats[gaussian];
    const V sx = hn::Set(kF, s.x_px), sy = hn::Set(kF, s.y_px), log2_opacity = hn::Set(kF, s.log2_opacity);
    const V qa = hn::Set(kF, s.qa), qb = hn::Set(kF, s.qb), qc = hn::Set(kF, s.qc);
    auto units = hn::Zero(kI), units_inside = hn::Zero(kI);
    V clearest = hn::Zero(kF);
    for (int v = 0; v < kVectors; ++v) {
      // All vectors of a block have the same columns: the compiler finds dx, constant and linear once.
      const V dx = hn::Sub(px[kSameColumns ? 0 : v], sx), dy = hn::Sub(py[v], sy);
      const V constant = fma(hn::Mul(qa, dx), dx, log2_opacity), linear = hn::Mul(qb, dx);
      const V alpha = hn::Min(exp2_of(fma(fma(qc, dy, linear), dy, constant)), alpha_max);
      const V before = transmittance[v];
      const auto counts = hn::And(hn::Ge(alpha, alpha_min), hn::Ge(before, stop));
      const V weight = hn::IfThenElseZero(counts, hn::Mul(alpha, before));
      const V after = hn::Sub(before, weight);
      transmittance[v] = after;
      clearest = hn::Max(clearest, after);
      if constexpr (kPaint == Paint::kGroups) {
        if (chunk->group[i] != kNoGroup && !hn::AllFalse(kF, counts)) {
          alignas(64) float lane[kWidth];
          hn::Store(weight, kF, lane);
          for (int l = 0; l < kWidth; ++l)
            if (lane[l] > 0) groups->add(begin + v * kWidth + l, chunk->group[i], lane[l]);
        }
      }
      if constexpr (kPaint == Paint::kLabel) red[v] = fma(weight, hn::Set(kF, chunk->label[i]), red[v]);
      if constexpr (kPaint == Paint::kColour) {
        red[v] = fma(weight, hn::Set(kF, s.red), red[v]);
        green[v] = fma(weight, hn::Set(kF, s.green), green[v]);
        blue[v] = fma(weight, hn::Set(kF, s.blue), blue[v]);
      }
      if constexpr (kDepth) {
        depth[v] = fma(weight, hn::Set(kF, s.depth), depth[v]);
        const auto crosses = hn::And(hn::Ge(before, half), hn::Lt(after, half));
        median[v] = hn::IfThenElse(crosses, hn::Set(kF, s.depth), median[v]);
        hit[v] = hn::IfThenElse(hn::RebindMask(kI, crosses), hn::Set(kI, static_cast<std::int32_t>(gaussian)),
                                hit[v]);
      }
      if constexpr (kSums) {
        const V share = whole_pixels ? hn::IfThenElseZero(counts, hn::Set(kF, 1.0f)) : weight;
        const V shifted =
            fma(share, hn::Set(kF, static_cast<float>(MaskedSums::kUnitsPerPixel)), hn::Set(kF, kRoundShift));
        const auto u = hn::Sub(hn::BitCast(kI, shifted), hn::Set(kI, kRoundShiftBits));
        units = hn::Add(units, u);
        if (some_object) units_inside = hn::Add(units_inside, hn::And(u, object[v]));
      }
    }
    if constexpr (kSums) {
      const auto add = [&](std::int32_t* sum, hn::Vec<IntLanes> more) {
        hn::Store(hn::Add(hn::Load(kI, sum), more), kI, sum);
      };
      add(&chunk->total[i * kWidth], units);
      if (some_object) add(&chunk->inside[i * kWidth], units_inside);
    }
    opaque = hn::AllTrue(kF, hn::Lt(clearest, stop));
  }
  for (int v = 0; v < kVectors; ++v) {
    const int at = begin + v * kWidth;
    hn::Store(transmittance[v], kF, &pixels->transmittance[at]);
    if constexpr (kPaint == Paint::kLabel || kPaint == Paint::kColour)
      hn::Store(red[v], kF, &pixels->red[at]);
    if constexpr (kPaint == Paint::kColour) {
      hn::Store(green[v], kF, &pixels->green[at]);
      hn::Store(blue[v], kF, &pixels->blue[at]);
    }
    if constexpr (kDepth) {
      hn::Store(depth[v], kF, &pixels->depth[at]);
      hn::Store(median[v], kF, &pixels->median[at]);
      hn::Store(hit[v], kI, &pixels->hit[at]);
    }
  }
  return opaque;
}

// Blends the chunk into every block that still lets light through. known: null, or its lists of an earlier
// drawing.
template <Paint kPaint, bool kDepth, bool kSums>
void blend_chunk(int tile_x, int tile_y, ListReader* known, bool keep_lists, Workspace* work) {
  constexpr std::uint32_t kRowOfBlocks = (1u << kBlocksAcross) - 1;
  TilePixels& pixels = work->pixels;
  for (int row = 0; row < kBlocksAcross; ++row) {
    const std::uint32_t alive = pixels.alive >> (row * kBlocksAcross) & kRowOfBlocks;
    const auto x0 = static_cast<float>(tile_x), y0 = static_cast<float>(tile_y + row * kBlockPx);
    if (known)
      known->read_row(alive, &work->lists);
    else if (alive != 0)
      list_row(work->chunk, x0, y0, alive, &work->lists);
    else
      work->lists.count.fill(0);
    if (keep_lists) write_row(work->lists, &work->found);
    for (int b = 0; b < kBlocksAcross; ++b) {
      if (!(alive >> b & 1)) continue;
      const int block = row * kBlocksAcross + b;
      if (blend_block<kPaint, kDepth, kSums>(x0 + static_cast<float>(b * kBlockPx), y0, block,
                                             work->lists.splat[b].data(), work->lists.count[b], &pixels,
                                             &work->chunk, &work->groups))
        pixels.alive &= ~(1u << block);
    }
  }
}

void store_sums(const Chunk& chunk, const std::uint32_t* order, PairSums* sums) {
  const auto sum = [](const std::int32_t* lanes) {
    return static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(kI, hn::Load(kI, lanes))));
  };
  for (int i = 0; i < chunk.size; ++i)
    sums[order[i]] = {sum(&chunk.total[i * kWidth]), sum(&chunk.inside[i * kWidth])};
}

// What is worth keeping of a pixel's groups, heaviest first, ties by number.
void store_groups(const TileGroups& groups, int i, float least, std::vector<GroupWeight>* to) {
  to->clear();
  const auto& list = groups.of[static_cast<std::size_t>(i)];
  for (int k = 0; k < groups.count[static_cast<std::size_t>(i)]; ++k)
    if (list[static_cast<std::size_t>(k)].weight >= least) to->push_back(list[static_cast<std::size_t>(k)]);
  std::ranges::sort(*to, [](const GroupWeight& a, const GroupWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.group < b.group;
  });
}

template <Paint kPaint, bool kDepth>
void store_pixels(const TileBlend& what, int tile_x, int tile_y, const TilePixels& pixels,
                  const TileGroups& groups, RasterOutput* to) {
  RasterOutput& out = *to;
  for (int i = 0; i < kTilePixels; ++i) {
    const int block = i / kBlockPixels, p = i % kBlockPixels;
    const int x = tile_x + block % kBlocksAcross * kBlockPx + p % kBlockPx - what.roi.x0;
    const int y = tile_y + block / kBlocksAcross * kBlockPx + p / kBlockPx - what.roi.y0;
    if (!out.alpha.contains(x, y)) continue;
    const float transmittance = pixels.transmittance[i];
    out.alpha.at(x, y) = 1 - transmittance;
    if constexpr (kPaint == Paint::kGroups)
      store_groups(groups, i, what.options.least_group_weight, &out.groups.at(x, y));
    if constexpr (kPaint == Paint::kLabel) out.label_share.at(x, y) = pixels.red[i];
    if constexpr (kPaint == Paint::kColour)
      out.colour.at(x, y) =
          glm::vec3(pixels.red[i], pixels.green[i], pixels.blue[i]) + transmittance * what.options.background;
    if constexpr (kDepth) {
      out.expected_depth.at(x, y) = transmittance < 1 ? pixels.depth[i] / (1 - transmittance) : 0;
      out.median_depth.at(x, y) = pixels.median[i];
      out.first_hit.at(x, y) = pixels.hit[i];
    }
  }
}

// One per thread, on the heap: thread-local storage is taken from every thread's stack.
Workspace& workspace() {
  thread_local const auto work = std::make_unique<Workspace>();
  return *work;
}

template <Paint kPaint, bool kDepth, bool kSums>
void draw_tile(const TileBlend& what, int tile, RasterOutput* out) {
  Workspace& work = workspace();
  const TileGrid& grid = what.grid;
  const int tile_x = (tile % grid.tiles_x + grid.first_tile_x) * kTilePx;
  const int tile_y = (tile / grid.tiles_x + grid.first_tile_y) * kTilePx;
  const std::size_t first = grid.first_entry[static_cast<std::size_t>(tile)];
  const TileEntry* entries = grid.entries.data() + first;
  start_pixels(what, tile_x, tile_y, &work.pixels);
  if constexpr (kPaint == Paint::kGroups) work.groups.count.fill(0);
  const std::span<const std::uint32_t> order = drawn_order(grid, tile, what.shown, &work.sort_space);
  TileLists* lists =
      what.lists && what.shown.empty() ? &(*what.lists)[static_cast<std::size_t>(tile)] : nullptr;
  std::optional<ListReader> known;
  if (lists && lists->complete) known.emplace(ListReader{*lists});
  const auto shows_whole = [](int tile_px, int roi_begin, int roi_end, int picture_end) {
    return tile_px >= roi_begin && std::min(tile_px + kTilePx, picture_end) <= roi_end;
  };
  const bool keep_lists = lists && !known && shows_whole(tile_x, what.roi.x0, what.roi.x1, what.picture.x1) &&
                          shows_whole(tile_y, what.roi.y0, what.roi.y1, what.picture.y1);
  work.found.splat.clear();
  work.found.count.clear();
  std::size_t done = 0;
  while (done < order.size() && work.pixels.alive != 0) {
    const std::size_t size = std::min<std::size_t>(kChunk, order.size() - done);
    gather(what, entries, order.subspan(done, size), !known, &work.chunk);
    blend_chunk<kPaint, kDepth, kSums>(tile_x, tile_y, known ? &*known : nullptr, keep_lists, &work);
    if constexpr (kSums) store_sums(work.chunk, order.data() + done, what.pair_sums + first);
    done += size;
  }
  if constexpr (kSums)
    for (; done < order.size(); ++done) what.pair_sums[first + order[done]] = {0, 0};
  store_pixels<kPaint, kDepth>(what, tile_x, tile_y, work.pixels, work.groups, out);
  if (keep_lists) *lists = {work.found.splat, work.found.count, true};
}

using DrawTile = void (*)(const TileBlend&, int, RasterOutput*);

template <Paint kPaint>
DrawTile draw_tile_with(bool depth, bool sums) {
  if (depth) return sums ? draw_tile<kPaint, true, true> : draw_tile<kPaint, true, false>;
  return sums ? draw_tile<kPaint, false, true> : draw_tile<kPaint, false, false>;
}

void blend_tiles(const TileBlend& what, const Job& job, RasterOutput* out) {
  const DrawTile draw = (what.options.colour            ? draw_tile_with<Paint::kColour>
                         : !what.options.groups.empty() ? draw_tile_with<Paint::kGroups>
                         : !what.options.labels.empty()
                             ? draw_tile_with<Paint::kLabel>
                             : draw_tile_with<Paint::kNone>)(what.options.depth, what.pair_sums != nullptr);
  const TileGrid& grid = what.grid;
  const PixelRect& roi = what.roi;
  const int left = std::max(0, roi.x0 / kTilePx - grid.first_tile_x),
            right = std::min(grid.tiles_x, (roi.x1 + kTilePx - 1) / kTilePx - grid.first_tile_x);
  const int top = std::max(0, roi.y0 / kTilePx - grid.first_tile_y),
            bottom = std::min(grid.tiles_y, (roi.y1 + kTilePx - 1) / kTilePx - grid.first_tile_y);
  const int across = right - left;
  tbb::parallel_for(0, across * (bottom - top), [&](int i) {
    if (!job.cancelled()) draw(what, (top + i / across) * grid.tiles_x + left + i % across, out);
  });
}

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatcut {

HWY_EXPORT(blend_tiles);
HWY_EXPORT(target_name);

void blend_tiles(const TileBlend& what, const Job& job, RasterOutput* out) {
  HWY_DYNAMIC_DISPATCH(blend_tiles)(what, job, out);
}

const char* blend_simd_target() {
  return HWY_DYNAMIC_DISPATCH(target_name)();
}

}  // namespace splatcut
#endif
