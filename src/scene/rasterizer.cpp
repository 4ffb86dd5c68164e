#include "scene/rasterizer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

#include "scene/splat_math.h"
#include "scene/tile_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scene/rasterizer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBlockPx = 4;                         // blocks of 4x4 pixels keep their state in registers
constexpr int kBlockPixels = kBlockPx * kBlockPx;
constexpr int kBlocksPerTile = (kTilePx / kBlockPx) * (kTilePx / kBlockPx);
constexpr float kLog2AlphaMin = -7.994353436858858f;

using Lanes = hn::CappedTag<float, kBlockPixels>;
using IntLanes = hn::RebindToSigned<Lanes>;
using V = hn::Vec<Lanes>;
constexpr Lanes kF;
constexpr IntLanes kI;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(kF));
constexpr int kVectors = kBlockPixels / kWidth;

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

// 2^p for p <= 0, relative error below 3e-7: integer part into the exponent, Taylor series of degree 6.
HWY_INLINE V exp2_of(V p) {
  p = hn::Max(p, hn::Set(kF, -126.0f));
  const V whole = hn::Round(p);
  const V f = hn::Sub(p, whole);
  V r = hn::Set(kF, 1.5403530e-4f);
  r = fma(r, f, hn::Set(kF, 1.3333558e-3f));
  r = fma(r, f, hn::Set(kF, 9.6181291e-3f));
  r = fma(r, f, hn::Set(kF, 5.5504109e-2f));
  r = fma(r, f, hn::Set(kF, 2.4022651e-1f));
  r = fma(r, f, hn::Set(kF, 6.9314718e-1f));
  r = fma(r, f, hn::Set(kF, 1.0f));
  const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(kI, whole), hn::Set(kI, 127)));
  return hn::Mul(r, hn::BitCast(kF, exponent));
}

// The splats of one tile, as arrays padded to whole vectors.
struct TileList {
  std::vector<float> x, y, qa, qb, qc, log2_opacity;
  std::vector<std::uint32_t> entry;
  std::vector<std::int32_t> block;           // entries that touch the block at hand
  std::vector<std::int32_t> total, inside;   // sums of this tile, 2^-16 pixel: at most 256 pixels, fits 32 bits
  int size = 0;
};

void gather(const TileGrid& grid, int tile, bool sums, TileList* list) {
  const std::uint32_t first = grid.first_entry[tile], last = grid.first_entry[tile + 1];
  const std::size_t n = last - first, padded = (n + 15) / 16 * 16;
  for (auto* v : {&list->x, &list->y, &list->qa, &list->qb, &list->qc, &list->log2_opacity})
    if (v->size() < padded + 16) v->resize(padded + 16);
  if (list->block.size() < padded + 16) list->block.resize(padded + 16);
  list->entry.assign(grid.entries.begin() + first, grid.entries.begin() + last);
  for (std::size_t i = 0; i < n; ++i) {
    const BlendSplat& s = grid.splats[list->entry[i]];
    list->x[i] = s.x_px;
    list->y[i] = s.y_px;
    list->qa[i] = s.qa;
    list->qb[i] = s.qb;
    list->qc[i] = s.qc;
    list->log2_opacity[i] = s.log2_opacity;
  }
  for (std::size_t i = n; i < padded; ++i) {  // padding touches nothing
    list->x[i] = list->y[i] = 0;
    list->qa[i] = list->qc[i] = -1;
    list->qb[i] = 0;
    list->log2_opacity[i] = -1e9f;
  }
  list->size = static_cast<int>(n);
  if (sums) {
    list->total.assign(n, 0);
    list->inside.assign(n, 0);
  }
}

// Lists the splats whose alpha may reach 1/255 at some pixel centre of the block at (x0, y0), in order.
int filter_block(float x0, float y0, TileList* list) {
  const V slack = hn::Set(kF, kLog2AlphaMin - 1e-2f), zero = hn::Zero(kF), half = hn::Set(kF, -0.5f);
  const V left = hn::Set(kF, x0 + 0.5f), right = hn::Set(kF, x0 + kBlockPx - 0.5f);
  const V top = hn::Set(kF, y0 + 0.5f), bottom = hn::Set(kF, y0 + kBlockPx - 0.5f);
  int count = 0;
  for (int i = 0; i < list->size; i += kWidth) {
    const V x = hn::LoadU(kF, &list->x[i]), y = hn::LoadU(kF, &list->y[i]);
    const V qa = hn::LoadU(kF, &list->qa[i]), qb = hn::LoadU(kF, &list->qb[i]), qc = hn::LoadU(kF, &list->qc[i]);
    const V dx0 = hn::Sub(left, x), dx1 = hn::Sub(right, x), dy0 = hn::Sub(top, y), dy1 = hn::Sub(bottom, y);
    const auto exponent = [&](V dx, V dy) {
      return hn::Add(hn::Mul(hn::Add(hn::Mul(qa, dx), hn::Mul(qb, dy)), dx), hn::Mul(hn::Mul(qc, dy), dy));
    };
    // Of the box, only the edges facing the mean can hold the largest exponent.
    const V dx = hn::Min(hn::Max(zero, dx0), dx1), dy = hn::Min(hn::Max(zero, dy0), dy1);
    const V along_y = hn::Min(hn::Max(hn::Div(hn::Mul(hn::Mul(half, qb), dx), qc), dy0), dy1);
    const V along_x = hn::Min(hn::Max(hn::Div(hn::Mul(hn::Mul(half, qb), dy), qa), dx0), dx1);
    const V best = hn::Max(exponent(dx, along_y), exponent(along_x, dy));
    const auto touches = hn::Ge(hn::Add(best, hn::LoadU(kF, &list->log2_opacity[i])), slack);
    if (hn::AllFalse(kF, touches)) continue;
    count += static_cast<int>(hn::CompressBlendedStore(hn::Iota(kI, i), hn::RebindMask(kI, touches), kI,
                                                       list->block.data() + count));
  }
  while (count > 0 && list->block[count - 1] >= list->size) --count;
  return count;
}

struct View {
  const TileGrid& grid;
  const RasterOptions& options;
  PixelRect roi;
  RasterOutput* out;
};

template <bool kColour, bool kDepth, bool kSums>
void blend_block(const View& view, int x0, int y0, int count, TileList* list) {
  alignas(64) float px[kBlockPixels], py[kBlockPixels], start[kBlockPixels];
  alignas(64) std::int32_t object[kBlockPixels];
  int object_pixels = 0;
  for (int i = 0; i < kBlockPixels; ++i) {
    const int x = x0 + i % kBlockPx, y = y0 + i / kBlockPx;
    const bool drawn = x >= view.roi.x0 && x < view.roi.x1 && y >= view.roi.y0 && y < view.roi.y1;
    px[i] = static_cast<float>(x) + 0.5f;
    py[i] = static_cast<float>(y) + 0.5f;
    start[i] = drawn ? 1.0f : 0.0f;  // pixels outside are opaque from the start: they neither draw nor count
    if constexpr (kSums) {
      object[i] = drawn && view.options.sum_mask->at(x, y) ? -1 : 0;
      object_pixels -= object[i];
    }
  }
  V transmittance[kVectors], red[kVectors], green[kVectors], blue[kVectors], depth[kVectors], median[kVectors];
  hn::Vec<IntLanes> hit[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    transmittance[v] = hn::Load(kF, start + v * kWidth);
    red[v] = green[v] = blue[v] = depth[v] = median[v] = hn::Zero(kF);
    hit[v] = hn::Set(kI, -1);
  }
  const V stop = hn::Set(kF, kTransmittanceStop), alpha_min = hn::Set(kF, kAlphaMin), alpha_max = hn::Set(kF, kAlphaMax);
  const V half = hn::Set(kF, 0.5f);
  for (int k = 0; k < count; ++k) {
    const int i = list->block[k];
    const BlendSplat& s = view.grid.splats[list->entry[i]];
    const V sx = hn::Set(kF, s.x_px), sy = hn::Set(kF, s.y_px), o = hn::Set(kF, s.log2_opacity);
    const V qa = hn::Set(kF, s.qa), qb = hn::Set(kF, s.qb), qc = hn::Set(kF, s.qc);
    auto units = hn::Zero(kI), units_inside = hn::Zero(kI);
    auto all_stopped = hn::Lt(hn::Zero(kF), stop);
    for (int v = 0; v < kVectors; ++v) {
      const V dx = hn::Sub(hn::Load(kF, px + v * kWidth), sx), dy = hn::Sub(hn::Load(kF, py + v * kWidth), sy);
      const V power = fma(fma(qa, dx, hn::Mul(qb, dy)), dx, fma(hn::Mul(qc, dy), dy, o));
      const V alpha = hn::Min(exp2_of(power), alpha_max);
      const V before = transmittance[v];
      const auto counts = hn::And(hn::Ge(alpha, alpha_min), hn::Ge(before, stop));
      const V weight = hn::IfThenElseZero(counts, hn::Mul(alpha, before));
      const V after = hn::Sub(before, weight);
      transmittance[v] = after;
      all_stopped = hn::And(all_stopped, hn::Lt(after, stop));
      if constexpr (kColour) {
        red[v] = fma(weight, hn::Set(kF, s.red), red[v]);
        green[v] = fma(weight, hn::Set(kF, s.green), green[v]);
        blue[v] = fma(weight, hn::Set(kF, s.blue), blue[v]);
      }
      if constexpr (kDepth) {
        depth[v] = fma(weight, hn::Set(kF, s.depth), depth[v]);
        const auto crosses = hn::And(hn::Ge(before, half), hn::Lt(after, half));
        median[v] = hn::IfThenElse(crosses, hn::Set(kF, s.depth), median[v]);
        hit[v] = hn::IfThenElse(hn::RebindMask(kI, crosses), hn::Set(kI, static_cast<std::int32_t>(s.gaussian)), hit[v]);
      }
      if constexpr (kSums) {
        const auto u = hn::NearestInt(hn::Mul(weight, hn::Set(kF, 65536.0f)));
        units = hn::Add(units, u);
        if (object_pixels != 0) units_inside = hn::Add(units_inside, hn::And(u, hn::Load(kI, object + v * kWidth)));
      }
    }
    if constexpr (kSums) {
      list->total[i] += hn::GetLane(hn::SumOfLanes(kI, units));
      if (object_pixels != 0) list->inside[i] += hn::GetLane(hn::SumOfLanes(kI, units_inside));
    }
    if (hn::AllTrue(kF, all_stopped)) break;
  }
  alignas(64) float t[kBlockPixels], r[kBlockPixels], g[kBlockPixels], b[kBlockPixels], d[kBlockPixels], m[kBlockPixels];
  alignas(64) std::int32_t h[kBlockPixels];
  for (int v = 0; v < kVectors; ++v) {
    hn::Store(transmittance[v], kF, t + v * kWidth);
    hn::Store(red[v], kF, r + v * kWidth);
    hn::Store(green[v], kF, g + v * kWidth);
    hn::Store(blue[v], kF, b + v * kWidth);
    hn::Store(depth[v], kF, d + v * kWidth);
    hn::Store(median[v], kF, m + v * kWidth);
    hn::Store(hit[v], kI, h + v * kWidth);
  }
  RasterOutput& out = *view.out;
  for (int i = 0; i < kBlockPixels; ++i) {
    if (start[i] == 0) continue;
    const int x = x0 + i % kBlockPx - view.roi.x0, y = y0 + i / kBlockPx - view.roi.y0;
    out.alpha.at(x, y) = 1 - t[i];
    if constexpr (kColour) out.colour.at(x, y) = glm::vec3(r[i], g[i], b[i]) + t[i] * view.options.background;
    if constexpr (kDepth) {
      out.expected_depth.at(x, y) = t[i] < 1 ? d[i] / (1 - t[i]) : 0;
      out.median_depth.at(x, y) = m[i];
      out.first_hit.at(x, y) = h[i];
    }
  }
}

void add_sums(const TileGrid& grid, const TileList& list, MaskedSums* sums) {
  const auto add = [](std::int64_t& to, std::int32_t units) {
    if (units) std::atomic_ref(to).fetch_add(units, std::memory_order_relaxed);
  };
  for (int i = 0; i < list.size; ++i) {
    const std::uint32_t gaussian = grid.splats[list.entry[i]].gaussian;
    add(sums->total[gaussian], list.total[i]);
    add(sums->inside[gaussian], list.inside[i]);
  }
}

template <bool kColour, bool kDepth, bool kSums>
void draw_tile(const View& view, int tile) {
  thread_local TileList list;
  gather(view.grid, tile, kSums, &list);
  const int tile_x = (tile % view.grid.tiles_x + view.grid.first_tile_x) * kTilePx;
  const int tile_y = (tile / view.grid.tiles_x + view.grid.first_tile_y) * kTilePx;
  for (int block = 0; block < kBlocksPerTile; ++block) {
    const int x0 = tile_x + block % (kTilePx / kBlockPx) * kBlockPx, y0 = tile_y + block / (kTilePx / kBlockPx) * kBlockPx;
    if (x0 >= view.roi.x1 || y0 >= view.roi.y1 || x0 + kBlockPx <= view.roi.x0 || y0 + kBlockPx <= view.roi.y0) continue;
    const int count = filter_block(static_cast<float>(x0), static_cast<float>(y0), &list);
    blend_block<kColour, kDepth, kSums>(view, x0, y0, count, &list);
  }
  if constexpr (kSums) add_sums(view.grid, list, view.options.sums);
}

using DrawTile = void (*)(const View&, int);

void draw_tiles(const TileGrid& grid, const RasterOptions& options, const PixelRect& roi, const Job& job, RasterOutput* out) {
  static constexpr DrawTile kDraw[2][2][2] = {
      {{draw_tile<false, false, false>, draw_tile<false, false, true>}, {draw_tile<false, true, false>, draw_tile<false, true, true>}},
      {{draw_tile<true, false, false>, draw_tile<true, false, true>}, {draw_tile<true, true, false>, draw_tile<true, true, true>}}};
  const DrawTile draw = kDraw[options.colour][options.depth][options.sums != nullptr];
  const View view{grid, options, roi, out};
  tbb::parallel_for(0, grid.tiles_x * grid.tiles_y, [&](int tile) {
    if (!job.cancelled()) draw(view, tile);
  });
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatcut {

HWY_EXPORT(draw_tiles);
HWY_EXPORT(target_name);

RasterOutput rasterize(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options, const Job& job) {
  assert(options.colour_override.empty() || options.colour_override.size() == cloud.size());
  assert(options.shown.empty() || options.shown.size() == cloud.size());
  assert(!options.sums || (options.sum_mask && options.sums->total.size() == cloud.size() &&
                           options.sum_mask->width() == camera.width_px && options.sum_mask->height() == camera.height_px));
  const PixelRect roi = options.roi.value_or(PixelRect{0, 0, camera.width_px, camera.height_px});
  assert(roi.x0 >= 0 && roi.y0 >= 0 && roi.x1 <= camera.width_px && roi.y1 <= camera.height_px);
  RasterOutput out;
  if (options.colour) out.colour = Image<glm::vec3>(roi.width(), roi.height());
  out.alpha = Image<float>(roi.width(), roi.height());
  if (options.depth) {
    out.expected_depth = out.median_depth = Image<float>(roi.width(), roi.height());
    out.first_hit = Image<std::int32_t>(roi.width(), roi.height(), -1);
  }
  if (roi.empty()) return out;
  const TileGrid grid = bin_splats(cloud, camera, options, job);
  out.visible = grid.splats.size();
  out.pairs = grid.entries.size();
  if (!job.cancelled()) HWY_DYNAMIC_DISPATCH(draw_tiles)(grid, options, roi, job, &out);
  return out;
}

const char* rasterizer_simd_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace splatcut
#endif
