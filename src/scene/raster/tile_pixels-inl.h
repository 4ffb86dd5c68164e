// The pixels of a tile: how they begin, what is summed up in each, how they become pictures.
// Compiled once per SIMD target, within tile_blend.cpp, hence the guard that each target turns round.
#if defined(SPLATCUT_TILE_PIXELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPLATCUT_TILE_PIXELS_INL_H
#undef SPLATCUT_TILE_PIXELS_INL_H
#else
#define SPLATCUT_TILE_PIXELS_INL_H
#endif

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "scene/raster/tile_blend.h"
#include "scene/raster/tile_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace splatcut {
namespace HWY_NAMESPACE {

// What is summed up per pixel beside the transmittance.
enum class Paint { kNone, kLabel, kColour, kGroups, kColourAndGroups, kGaussians };

constexpr bool paints_colour(Paint paint) {
  return paint == Paint::kColour || paint == Paint::kColourAndGroups;
}
constexpr bool paints_groups(Paint paint) {
  return paint == Paint::kGroups || paint == Paint::kColourAndGroups;
}

// What is summed up per splat.
enum class Sums { kNone, kMask, kPlanes };

// The pixels of a tile, block by block, row by row within a block.
struct TilePixels {
  alignas(64) std::array<float, kTilePixels> transmittance, red, green, blue, depth, median;
  alignas(64) std::array<std::int32_t, kTilePixels> hit;
  alignas(64) std::array<std::int32_t, kTilePixels> object;  // -1 inside the mask, else 0
  std::array<int, kBlocks> object_pixels;
  alignas(64) std::array<std::array<float, kTilePixels>, PlaneSums::kMost> plane;
  bool whole_pixels = false;  // sums count pixels, not weights
  std::uint32_t alive = 0;    // bit b: some pixel of block b can still change
};

// Weights listed per pixel of a tile.
struct PixelLists {
  static constexpr int kMost = 48;  // of a pixel; further ones take the place of the least
  std::array<std::array<GroupWeight, kMost>, kTilePixels> of;
  std::array<int, kTilePixels> count;

  void add(int pixel, const GroupWeight& more) {
    auto& list = of[static_cast<std::size_t>(pixel)];
    int& n = count[static_cast<std::size_t>(pixel)];
    if (n < kMost) {
      list[static_cast<std::size_t>(n++)] = more;
      return;
    }
    auto least_of_all = std::ranges::min_element(list, {}, &GroupWeight::weight);
    if (least_of_all->weight < more.weight) *least_of_all = more;
  }

  // Lists the lanes that reach `least`; those begin at that pixel.
  void add(int pixel, std::uint32_t group, V weight, float least) {
    if (hn::AllTrue(kF, hn::Lt(weight, hn::Set(kF, least)))) return;
    alignas(64) std::array<float, kWidth> lane;
    hn::Store(weight, kF, lane.data());
    for (int l = 0; l < kWidth; ++l)
      if (lane[static_cast<std::size_t>(l)] >= least)
        add(pixel + l, {group, lane[static_cast<std::size_t>(l)]});
  }

  std::span<GroupWeight> at(int pixel) {
    return std::span(of[static_cast<std::size_t>(pixel)])
        .first(static_cast<std::size_t>(count[static_cast<std::size_t>(pixel)]));
  }
};

// What the pixels of a tile have got from each group so far.
struct TileGroups {
  struct Weights {
    alignas(64) std::array<float, kTilePixels> of;
  };
  std::vector<std::uint32_t> met;   // groups of the tile's splats
  std::vector<Weights> weight;      // of those; what is beyond them is memory kept
  std::vector<std::int32_t> place;  // in `met`, by group; -1: not met

  void clear() {
    for (const std::uint32_t group : met) place[group] = -1;
    met.clear();
  }
  std::int32_t place_of(std::uint32_t group) {
    if (group == kNoGroup) return -1;
    if (group >= place.size()) place.resize(group + std::size_t{1}, -1);
    if (place[group] >= 0) return place[group];
    place[group] = static_cast<std::int32_t>(met.size());
    met.push_back(group);
    if (met.size() > weight.size()) weight.emplace_back();
    weight[met.size() - 1].of.fill(0);
    return place[group];
  }
  void add(int pixel, std::int32_t at, V more) {
    float* sum = &weight[static_cast<std::size_t>(at)].of[static_cast<std::size_t>(pixel)];
    hn::Store(hn::Add(hn::Load(kF, sum), more), kF, sum);
  }
  void list(float least, PixelLists* lists) const {
    for (std::size_t k = 0; k < met.size(); ++k)
      for (int pixel = 0; pixel < kTilePixels; pixel += kWidth)
        lists->add(pixel, met[k], hn::Load(kF, &weight[k].of[static_cast<std::size_t>(pixel)]), least);
  }
};

inline void start_pixels(const TileBlend& what, int tile_x, int tile_y, TilePixels* pixels) {
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
    for (std::size_t k = 0; what.plane_sums && k < what.options.sum_planes.size(); ++k)
      pixels->plane[k][static_cast<std::size_t>(i)] =
          drawn ? what.options.sum_planes[k].at(x - what.roi.x0, y - what.roi.y0) : 0;
    if (!what.pair_sums) continue;
    const bool object = drawn && what.options.sum_mask->at(x, y);
    pixels->object[i] = object ? -1 : 0;
    pixels->object_pixels[block] += object;
  }
}

// Ties by number.
inline std::uint32_t group_of(std::span<GroupWeight> list) {
  std::ranges::sort(list, [](const GroupWeight& a, const GroupWeight& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.group < b.group;
  });
  return group_of_pixel(list);
}

template <Paint kPaint, bool kDepth>
inline void store_pixels(const TileBlend& what, int tile_x, int tile_y, const TilePixels& pixels,
                         PixelLists* lists, RasterOutput* to) {
  RasterOutput& out = *to;
  std::vector<GroupWeight>* memory = nullptr;
  if constexpr (kPaint == Paint::kGaussians) {
    memory = &out.gaussians.memory[tiles_of(what.roi).index(tile_x, tile_y)];
    memory->reserve(static_cast<std::size_t>(std::reduce(lists->count.begin(), lists->count.end())));
  }
  for (int i = 0; i < kTilePixels; ++i) {
    const int block = i / kBlockPixels, p = i % kBlockPixels;
    const int x = tile_x + block % kBlocksAcross * kBlockPx + p % kBlockPx - what.roi.x0;
    const int y = tile_y + block / kBlocksAcross * kBlockPx + p / kBlockPx - what.roi.y0;
    if (!out.alpha.contains(x, y)) continue;
    const float transmittance = pixels.transmittance[i];
    out.alpha.at(x, y) = 1 - transmittance;
    if constexpr (paints_groups(kPaint)) out.group.at(x, y) = group_of(lists->at(i));
    if constexpr (kPaint == Paint::kGaussians) {
      const std::span<const GroupWeight> list = lists->at(i);
      const auto at = memory->insert(memory->end(), list.begin(), list.end());  // reserved: nothing moves
      out.gaussians.of.at(x, y) = {at, list.size()};
    }
    if constexpr (kPaint == Paint::kLabel) out.label_share.at(x, y) = pixels.red[i];
    if constexpr (paints_colour(kPaint))
      out.colour.at(x, y) =
          glm::vec3(pixels.red[i], pixels.green[i], pixels.blue[i]) + transmittance * what.options.background;
    if constexpr (kDepth) {
      out.expected_depth.at(x, y) = transmittance < 1 ? pixels.depth[i] / (1 - transmittance) : 0;
      out.median_depth.at(x, y) = pixels.median[i];
      out.first_hit.at(x, y) = pixels.hit[i];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace splatcut
HWY_AFTER_NAMESPACE();

#endif  // SPLATCUT_TILE_PIXELS_INL_H
