// From a region of the picture, or a property, to Gaussians. One byte per Gaussian, 1 = selected.
//
// Visible-only takes what the picture shows: Gaussians most of whose visible weight (alpha T, see
// scene/raster/rasterizer.h) lies in the region. See-through takes every Gaussian whose centre projects into
// the region, down to a depth limit behind the visible surface.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "app/document/volume.h"
#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/max_flow.h"

namespace splatcut {

using Selection = std::vector<std::uint8_t>;

// kMaskObject where the pixel centre lies in the shape; width and height of the viewport. Even-odd rule.
Mask polygon_region(std::span<const glm::vec2> corners_px, int width, int height);
Mask rectangle_region(const glm::vec2& a_px, const glm::vec2& b_px, int width, int height);
Mask brush_region(std::span<const glm::vec2> path_px, float radius_px, int width, int height);

// shown: empty, or 0 for Gaussians that are not drawn and so cannot be selected.
Selection select_visible(const GaussianCloud& cloud, const Camera& camera, const Mask& region,
                         std::span<const std::uint8_t> shown, const Job& job = {});

struct SeeThroughOptions {
  const Image<float>* surface_depth =
      nullptr;  // camera z per pixel in any size of the same picture; 0: nothing there
  float depth_limit = std::numeric_limits<float>::infinity();  // scene units behind the surface
};
Selection select_through(const GaussianCloud& cloud, const Camera& camera, const Mask& region,
                         std::span<const std::uint8_t> shown, const SeeThroughOptions& options = {});

Selection select_volume(const GaussianCloud& cloud, const Volume& volume,
                        std::span<const std::uint8_t> shown);

// tolerance: largest difference in any channel of the base colour, [0, 1].
Selection select_colour(const GaussianCloud& cloud, const glm::vec3& colour, float tolerance);
// From `start` over the graph's edges, as long as the base colour stays that near to the start's.
Selection select_flood(const GaussianCloud& cloud, const FlowGraph& graph, std::size_t start, float tolerance,
                       std::span<const std::uint8_t> shown);
glm::vec3 base_colour(const GaussianCloud& cloud, std::size_t g);

enum class Property { kOpacity, kSize, kDepth };
// kOpacity: [0, 1]. kSize: log10 of the largest standard deviation, scene units. kDepth: camera z; needs a
// camera.
std::vector<float> property_values(const GaussianCloud& cloud, Property property,
                                   const Camera* camera = nullptr);
Selection select_range(std::span<const float> values, float low, float high);

struct Histogram {
  float low = 0, high = 1;
  std::vector<float> share;  // per bin, of the fullest bin
};
// Between the 0.1 % and 99.9 % quantiles: outliers cannot squeeze the rest into one bin.
Histogram histogram(std::span<const float> values, int bins);

// One step over the neighbour graph.
Selection grown(const FlowGraph& graph, const Selection& selection);
Selection shrunk(const FlowGraph& graph, const Selection& selection);

// Connected parts of the selection along graph edges no longer than `longest` scene units. part[g] is the
// number of g's part, from 0, the largest first; -1 where g is not selected.
struct Parts {
  std::vector<std::int32_t> part;
  std::vector<std::size_t> size;
};
Parts connected_parts(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection,
                      float longest = std::numeric_limits<float>::infinity());
Selection largest_part(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection);

struct FloaterOptions {
  double most_share = 0.01;  // a floater has at most this share of the selection's Gaussians
  float gap_spacings = 6;    // and is apart by more than this many times the usual neighbour distance
};
// Small clusters away from the rest of the selection.
Selection floaters(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection,
                   const FloaterOptions& options = {});

enum class SetOperation { kAdd, kRemove, kIntersect };
Selection combined(std::span<const std::uint8_t> before, std::span<const std::uint8_t> region,
                   SetOperation operation);

}  // namespace splatcut
