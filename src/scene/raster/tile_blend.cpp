#include "scene/raster/tile_blend.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "scene/raster/splat_math.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scene/raster/tile_blend.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "scene/raster/tile_lanes-inl.h"
#include "scene/raster/tile_pixels-inl.h"
#include "scene/raster/tile_splats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

struct Workspace {
  SortSpace sort_space;
  Chunk chunk;
  TileGroups groups;
  PixelLists listed;
  TilePixels pixels;
  BlockLists lists;
  TileLists found;  // on their way into TileBlend::lists
};

// Rounded to 2^-16.
HWY_INLINE hn::Vec<IntLanes> units_of(V v) {
  const V shifted =
      fma(v, hn::Set(kF, static_cast<float>(MaskedSums::kUnitsPerPixel)), hn::Set(kF, kRoundShift));
  return hn::Sub(hn::BitCast(kI, shifted), hn::Set(kI, kRoundShiftBits));
}

// Adds what splat i of the chunk has in the vector of pixels at `at`, times their values.
HWY_INLINE void add_planes(V weight, int at, int i, std::size_t planes, const TilePixels& pixels,
                           Chunk* chunk) {
  for (std::size_t k = 0; k < planes; ++k) {
    std::int32_t* sum = &chunk->plane[k][static_cast<std::size_t>(i * kWidth)];
    const V value = hn::Load(kF, &pixels.plane[k][static_cast<std::size_t>(at)]);
    hn::Store(hn::Add(hn::Load(kI, sum), units_of(hn::Mul(weight, value))), kI, sum);
  }
}

// Blends the listed splats of a chunk into the block with the corner (x0, y0). True when no pixel of it can
// change any more.
template <Paint kPaint, bool kDepth, Sums kSums>
bool blend_block(float x0, float y0, int block, const std::int32_t* list, int count, std::size_t planes,
                 float least_listed, Workspace* work) {
  TilePixels* pixels = &work->pixels;
  Chunk* chunk = &work->chunk;
  const int begin = block * kBlockPixels;
  const bool some_object = kSums == Sums::kMask && pixels->object_pixels[block] != 0,
             whole_pixels = kSums == Sums::kMask && pixels->whole_pixels;
  V px[kVectors], py[kVectors], transmittance[kVectors], red[kVectors], green[kVectors], blue[kVectors],
      depth[kVectors], median[kVectors];
  hn::Vec<IntLanes> hit[kVectors], object[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    const int at = begin + v * kWidth;
    px[v] = hn::Add(hn::Set(kF, x0), hn::Load(kF, kCentreX + v * kWidth % kBlockPx));
    py[v] = hn::Add(hn::Set(kF, y0), hn::Load(kF, kCentreY + v * kWidth));
    transmittance[v] = hn::Load(kF, &pixels->transmittance[at]);
    if constexpr (kPaint == Paint::kLabel || paints_colour(kPaint)) red[v] = hn::Load(kF, &pixels->red[at]);
    if constexpr (paints_colour(kPaint)) {
      green[v] = hn::Load(kF, &pixels->green[at]);
      blue[v] = hn::Load(kF, &pixels->blue[at]);
    }
    if constexpr (kDepth) {
      depth[v] = hn::Load(kF, &pixels->depth[at]);
      median[v] = hn::Load(kF, &pixels->median[at]);
      hit[v] = hn::Load(kI, &pixels->hit[at]);
    }
    if constexpr (kSums == Sums::kMask) object[v] = hn::Load(kI, &pixels->object[at]);
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
      if constexpr (paints_groups(kPaint))
        if (chunk->group[i] >= 0) work->groups.add(begin + v * kWidth, chunk->group[i], weight);
      if constexpr (kPaint == Paint::kGaussians)
        work->listed.add(begin + v * kWidth, gaussian, weight, least_listed);
      if constexpr (kPaint == Paint::kLabel) red[v] = fma(weight, hn::Set(kF, chunk->label[i]), red[v]);
      if constexpr (paints_colour(kPaint)) {
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
      if constexpr (kSums == Sums::kPlanes) add_planes(weight, begin + v * kWidth, i, planes, *pixels, chunk);
      if constexpr (kSums == Sums::kMask) {
        const V share = whole_pixels ? hn::IfThenElseZero(counts, hn::Set(kF, 1.0f)) : weight;
        const auto u = units_of(share);
        units = hn::Add(units, u);
        if (some_object) units_inside = hn::Add(units_inside, hn::And(u, object[v]));
      }
    }
    if constexpr (kSums == Sums::kMask) {
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
    if constexpr (kPaint == Paint::kLabel || paints_colour(kPaint)) hn::Store(red[v], kF, &pixels->red[at]);
    if constexpr (paints_colour(kPaint)) {
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
template <Paint kPaint, bool kDepth, Sums kSums>
void blend_chunk(int tile_x, int tile_y, ListReader* known, bool keep_lists, const RasterOptions& options,
                 Workspace* work) {
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
                                             work->lists.splat[b].data(), work->lists.count[b],
                                             options.sum_planes.size(), options.least_listed_weight, work))
        pixels.alive &= ~(1u << block);
    }
  }
}

void find_groups(std::span<const std::uint32_t> group_of, TileGroups* groups, Chunk* chunk) {
  for (int i = 0; i < chunk->size; ++i) chunk->group[i] = groups->place_of(group_of[chunk->gaussian[i]]);
}

void store_sums(const Chunk& chunk, const std::uint32_t* order, PairSums* sums) {
  const auto sum = [](const std::int32_t* lanes) {
    return static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(kI, hn::Load(kI, lanes))));
  };
  for (int i = 0; i < chunk.size; ++i)
    sums[order[i]] = {sum(&chunk.total[i * kWidth]), sum(&chunk.inside[i * kWidth])};
}

void store_planes(const TileBlend& what, std::size_t first, const std::uint32_t* order, const Chunk& chunk) {
  const std::size_t planes = what.options.sum_planes.size();
  for (int i = 0; i < chunk.size; ++i)
    for (std::size_t k = 0; k < planes; ++k)
      what.plane_sums[(first + order[i]) * planes + k] = hn::GetLane(
          hn::SumOfLanes(kI, hn::Load(kI, &chunk.plane[k][static_cast<std::size_t>(i * kWidth)])));
}

// One per thread, on the heap: thread-local storage is taken from every thread's stack.
Workspace& workspace() {
  thread_local const auto work = std::make_unique<Workspace>();
  return *work;
}

template <Paint kPaint, bool kDepth, Sums kSums>
void draw_tile(const TileBlend& what, int tile, RasterOutput* out) {
  Workspace& work = workspace();
  const TileGrid& grid = what.grid;
  const int tile_x = (tile % grid.tiles_x + grid.first_tile_x) * kTilePx;
  const int tile_y = (tile / grid.tiles_x + grid.first_tile_y) * kTilePx;
  const std::size_t first = grid.first_entry[static_cast<std::size_t>(tile)];
  const TileEntry* entries = grid.entries.data() + first;
  start_pixels(what, tile_x, tile_y, &work.pixels);
  if constexpr (paints_groups(kPaint)) work.groups.clear();
  if constexpr (paints_groups(kPaint) || kPaint == Paint::kGaussians) work.listed.count.fill(0);
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
    if constexpr (paints_groups(kPaint)) find_groups(what.options.groups, &work.groups, &work.chunk);
    blend_chunk<kPaint, kDepth, kSums>(tile_x, tile_y, known ? &*known : nullptr, keep_lists, what.options,
                                       &work);
    if constexpr (kSums == Sums::kMask) store_sums(work.chunk, order.data() + done, what.pair_sums + first);
    if constexpr (kSums == Sums::kPlanes) store_planes(what, first, order.data() + done, work.chunk);
    done += size;
  }
  if constexpr (kSums == Sums::kMask)
    for (; done < order.size(); ++done) what.pair_sums[first + order[done]] = {0, 0};
  if constexpr (paints_groups(kPaint)) work.groups.list(what.options.least_listed_weight, &work.listed);
  store_pixels<kPaint, kDepth>(what, tile_x, tile_y, work.pixels, &work.listed, out);
  if (keep_lists) *lists = {work.found.splat, work.found.count, true};
}

using DrawTile = void (*)(const TileBlend&, int, RasterOutput*);

template <Paint kPaint>
DrawTile draw_tile_with(bool depth, bool sums) {
  if (depth) return sums ? draw_tile<kPaint, true, Sums::kMask> : draw_tile<kPaint, true, Sums::kNone>;
  return sums ? draw_tile<kPaint, false, Sums::kMask> : draw_tile<kPaint, false, Sums::kNone>;
}

void blend_tiles(const TileBlend& what, const Job& job, RasterOutput* out) {
  const bool grouped = !what.options.groups.empty();
  const DrawTile masked = (what.options.colour && grouped ? draw_tile_with<Paint::kColourAndGroups>
                           : what.options.colour          ? draw_tile_with<Paint::kColour>
                           : grouped                      ? draw_tile_with<Paint::kGroups>
                           : what.options.list_gaussians  ? draw_tile_with<Paint::kGaussians>
                           : !what.options.labels.empty()
                               ? draw_tile_with<Paint::kLabel>
                               : draw_tile_with<Paint::kNone>)(what.options.depth, what.pair_sums != nullptr);
  const DrawTile draw = what.plane_sums ? draw_tile<Paint::kNone, false, Sums::kPlanes> : masked;
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

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace splatcut {

HWY_EXPORT(blend_tiles);

void blend_tiles(const TileBlend& what, const Job& job, RasterOutput* out) {
  HWY_DYNAMIC_DISPATCH(blend_tiles)(what, job, out);
}

}  // namespace splatcut
#endif
