// What one view shows of the scene, softly: every Gaussian's and every leaf's share of every pixel.
//
// In: cloud, hierarchy of parts, camera. Out: per pixel the weights alpha T of the Gaussians that make it,
// and the same summed by leaf. A labelling's picture follows from it without drawing: a pixel is object where
// its object weights reach 0.5, as in render_labels(). Unlike the Gaussian at the median depth of each pixel,
// the sums do not speckle on real captures. Cost: one drawing; 8 bytes per pixel and Gaussian listed, some 20
// of them a pixel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/raster/projected_view.h"
#include "segment/masks/seeds.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// Per pixel a list, row by row: entries first[i] .. first[i + 1] belong to pixel i, heaviest first.
struct PixelWeights {
  std::vector<std::uint32_t> first;  // pixels + 1
  std::vector<GroupWeight> entry;
  std::span<const GroupWeight> at(std::size_t pixel) const {
    return std::span(entry).subspan(first[pixel], first[pixel + 1] - first[pixel]);
  }
};

struct LeafView {
  Camera camera;
  PixelWeights gaussians, leaves;
  Image<float> depth;                // expected, camera z; 0 where nothing is
  bool whole = true;                 // false: Gaussians were left out
  std::vector<float> alone_px;       // per Gaussian: its pixels if nothing occluded it; empty: not known
  std::vector<float> leaf_px;        // per leaf: sum of its weights, pixels
  std::vector<float> leaf_frame_px;  // the same at the picture's frame
};

// seen: Gaussians that are drawn; null: all. Cancelled: what comes back must not be used.
LeafView leaf_view(const Drawer& drawer, const PartHierarchy& parts, const Camera& camera,
                   const Job& job = {}, const SeenGaussians& seen = {});

// The same from lists that are known: per pixel the Gaussians that make it.
LeafView leaf_view_of(const PartHierarchy& parts, const Camera& camera,
                      Image<std::vector<GroupWeight>> gaussians, Image<float> depth);

// Which leaf each pixel shows.
LeafPicture picture_of(const LeafView& view);

inline constexpr std::uint32_t kNoLevel = 0xffffffffu;

// Of a set of leaves that grows level by level, as along a chain of ancestors: per pixel, the first level at
// which the pixel shows the set; kNoLevel if it never does. level: per leaf, when it joins, or kNoLevel.
Image<std::uint32_t> shown_from(const LeafView& view, std::span<const std::uint32_t> level);

// Whether a person would take two sets of leaves for the same thing: IoU of their pixels, 0.8 at least.
bool look_alike(const LeafView& view, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

// The mask of a labelling, one label per group.
Mask shown(const PixelWeights& weights, const Camera& camera, std::span<const std::uint8_t> labels);

}  // namespace splatcut
