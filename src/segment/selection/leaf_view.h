// Soft view of the scene: the share that every Gaussian and every leaf has of every pixel.
//
// In: cloud, hierarchy of parts, camera. Out: per pixel the weights alpha T of the Gaussians that make it,
// and the same summed by leaf. The picture of any labelling follows without drawing: a pixel is object if its
// object weights reach 0.5, as in render_labels(). Unlike the Gaussian at the median depth of each pixel,
// these sums do not speckle on real captures. Cost: one drawing; 8 bytes per Gaussian listed, some 20 a
// pixel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/raster/projected_view.h"
#include "segment/masks/seeds.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// Lists of weights, one per pixel, row by row: entries first[i] to first[i + 1] - 1 belong to pixel i, leaves
// heaviest first.
struct PixelWeights {
  std::vector<std::uint32_t> first;  // start of each list, one more than there are pixels
  std::vector<GroupWeight> entry;
  std::span<const GroupWeight> at(std::size_t pixel) const {
    return std::span(entry).subspan(first[pixel], first[pixel + 1] - first[pixel]);
  }
};

struct LeafView {
  Camera camera;
  PixelWeights gaussians, leaves;
  Image<float> depth;                // expected depth as camera z, scene units; 0: nothing is there
  Image<std::uint8_t> steps;         // between pixels, without a jump in depth: steps_without_jump()
  Image<std::uint32_t> leaf;         // that each pixel shows; kNoPart: none
  Image<Rgb8> colour;                // its picture; empty: nobody needed it, see draw_colour()
  Image<std::uint16_t> colour_bins;  // of the picture, see colour_overlap.h; empty: not counted
  bool whole = true;                 // false: some Gaussians were left out
  std::vector<float> alone_px;       // pixels that each Gaussian has if nothing occludes it; empty: not known
  std::vector<float> gaussian_px;    // sum of each Gaussian's weights, pixels
  std::vector<float> leaf_px;        // sum of each leaf's weights, pixels
  std::vector<float> leaf_frame_px;  // sum of each leaf's weights at the picture's frame, pixels

  std::size_t bytes() const;
};

// Draws a view. seen: flags of the Gaussians to draw; null: all. If cancelled, the result must not be used.
LeafView leaf_view(const Drawer& drawer, const PartHierarchy& parts, const Camera& camera,
                   const Job& job = {}, const SeenGaussians& seen = {});

// Draws the view's colour, with the Gaussians that it was drawn with.
void draw_colour(const Drawer& drawer, LeafView* view, const Job& job = {}, const SeenGaussians& seen = {});

// Makes a view from known lists. gaussians: per pixel the weights of its Gaussians.
LeafView leaf_view_of(const PartHierarchy& parts, const Camera& camera, ListedWeights gaussians,
                      Image<float> depth);

// Picture of the leaf that each pixel shows.
LeafPicture picture_of(const LeafView& view);

inline constexpr std::uint32_t kNoLevel = 0xffffffffu;  // level of what never joins

// For a set of leaves that grows level by level, as along a chain of ancestors: the first level at which each
// pixel shows the set; kNoLevel: it never does. level: per leaf the level at which it joins, or kNoLevel.
Image<std::uint32_t> shown_from(const LeafView& view, std::span<const std::uint32_t> level);

// IoU of two sets of leaves; 1 where neither has a pixel. leaf_px: pixels per leaf. a, b: flags per leaf.
float iou(std::span<const float> leaf_px, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

// True if a person would take two sets of leaves for the same thing: their IoU is at least 0.8.
bool look_alike(const LeafView& view, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

// Mask of a labelling. labels: one per group of the weights (Gaussian or leaf), 1 = object.
Mask shown(const PixelWeights& weights, const Camera& camera, std::span<const std::uint8_t> labels);

}  // namespace splatcut
