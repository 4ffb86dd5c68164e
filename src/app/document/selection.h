// Selections of Gaussians by a region of the picture, a volume, a colour or a property. A selection has one
// byte per Gaussian, 1 = selected.
//
// select_visible() takes what the picture shows, by the visible weight (alpha T, see
// scene/raster/rasterizer.h) that lies in the region. select_through() takes what lies in the region at any
// depth, down to a depth limit behind the visible surface. Both, and volumes, go by the footprint of a
// Gaussian or by its centre, see TakenBy.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "app/placing/volume.h"
#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/max_flow.h"

namespace splatcut {

using Selection = std::vector<std::uint8_t>;

// Masks of shapes: kMaskObject where a pixel's centre lies in the shape, by the even-odd rule. width, height:
// size of the viewport, pixels.
Mask polygon_region(std::span<const glm::vec2> corners_px, int width, int height);
Mask rectangle_region(const glm::vec2& a_px, const glm::vec2& b_px, int width, int height);
Mask brush_region(std::span<const glm::vec2> path_px, float radius_px, int width, int height);

// What of a Gaussian must lie in a region or volume. kCentre: its centre. kFootprint: more than half of its
// visible weight; where visibility does not count, more than half of the eight points at one standard
// deviation along all its axes, or its core, which is its centre and more than half of the points at 0.6 of
// one.
enum class TakenBy { kFootprint, kCentre };

// The part of a brush's region that lies on the surface under its path: what can be reached from a pixel of
// the path, from pixel to pixel of the region, without a jump in depth.
// depth: camera z of the visible surface, scene units, of the same picture in any size; 0: nothing is there.
Mask surface_region(const Mask& region, std::span<const glm::vec2> path_px, const Image<float>& depth);

// shown, here and below: per Gaussian, 0 if it is not drawn and so cannot be selected; empty: all are drawn.
Selection select_visible(const GaussianCloud& cloud, const Camera& camera, const Mask& region,
                         std::span<const std::uint8_t> shown, TakenBy by, const Job& job = {});

struct SeeThroughOptions {
  // Camera z of the visible surface, in scene units, of the same picture in any size. 0: nothing is there.
  const Image<float>* surface_depth = nullptr;
  float depth_limit = std::numeric_limits<float>::infinity();  // distance behind the surface, scene units
  TakenBy by = TakenBy::kFootprint;
};
Selection select_through(const GaussianCloud& cloud, const Camera& camera, const Mask& region,
                         std::span<const std::uint8_t> shown, const SeeThroughOptions& options = {});

Selection select_volume(const GaussianCloud& cloud, const Volume& volume, std::span<const std::uint8_t> shown,
                        TakenBy by);

// Selects by base colour. tolerance: largest difference in any channel, [0, 1].
Selection select_colour(const GaussianCloud& cloud, const glm::vec3& colour, float tolerance);
// Selects from `start` over the graph's edges, as long as the base colour stays within the tolerance of the
// start's.
Selection select_flood(const GaussianCloud& cloud, const FlowGraph& graph, std::size_t start, float tolerance,
                       std::span<const std::uint8_t> shown);
glm::vec3 base_colour(const GaussianCloud& cloud, std::size_t g);  // colour of degree 0, clamped to [0, 1]

enum class Property { kOpacity, kSize, kDepth, kNeedle };
// Values of a property, one per Gaussian. kOpacity: [0, 1]. kSize: log10 of the largest standard deviation in
// scene units. kDepth: camera z in scene units; needs a camera. kNeedle: largest standard deviation over the
// middle one, [1, 1e4]; a disc has about 1.
std::vector<float> property_values(const GaussianCloud& cloud, Property property,
                                   const Camera* camera = nullptr);
Selection select_range(std::span<const float> values, float low, float high);  // low and high are included

struct Histogram {
  float low = 0, high = 1;
  std::vector<float> share;  // count of each bin over that of the fullest bin, [0, 1]
};
// Histogram between the 0.1 % and 99.9 % quantiles, so that outliers cannot squeeze the rest into one bin.
Histogram histogram(std::span<const float> values, int bins);

// The selection grown or shrunk by one step over the neighbour graph.
Selection grown(const FlowGraph& graph, const Selection& selection);
Selection shrunk(const FlowGraph& graph, const Selection& selection);

// Connected parts of a selection, the largest first.
struct Parts {
  std::vector<std::int32_t> part;  // number of each Gaussian's part, from 0; -1: not selected
  std::vector<std::size_t> size;   // number of Gaussians in each part
};
// most_gap: graph edges between ellipsoids of one standard deviation that lie farther apart, in scene units,
// do not connect.
Parts connected_parts(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection,
                      float most_gap = std::numeric_limits<float>::infinity());
Selection largest_part(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection);

struct FloaterOptions {
  double most_share = 0.01;  // a floater has at most this share of the selection's Gaussians
  float gap_spacings = 6;    // its gap to others is larger than this many median neighbour distances
};
// Selects floaters: small clusters away from the rest of the selection.
Selection floaters(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection,
                   const FloaterOptions& options = {});

enum class SetOperation { kAdd, kRemove, kIntersect };
// Combines two selections of one size.
Selection combined(std::span<const std::uint8_t> before, std::span<const std::uint8_t> region,
                   SetOperation operation);

}  // namespace splatcut
