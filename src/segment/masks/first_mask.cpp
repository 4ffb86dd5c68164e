#include "segment/masks/first_mask.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <queue>

#include "core/error.h"
#include "core/pixel_steps.h"
#include "scene/raster/depth_jump.h"
#include "segment/masks/cv_image.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr float kContrastCap = 20;  // Lab units: an edge is an edge, however strong

cv::Mat smooth_lab_of(const Image<Rgb8>& picture) {
  cv::Mat lab = lab_of(as_const_mat(picture));
  cv::GaussianBlur(lab, lab, {3, 3}, 0.8);  // splat texture is noise to a geodesic
  return lab;
}

struct GeodesicCost {
  const cv::Mat& lab;
  const Image<float>& depth;
  const FirstMaskOptions& options;

  float operator()(int x0, int y0, int x1, int y1) const {
    const auto& a = lab.at<cv::Vec3f>(y0, x0);
    const auto& b = lab.at<cv::Vec3f>(y1, x1);
    const float colour = static_cast<float>(cv::norm(a - b));
    const float z0 = depth.at(x0, y0), z1 = depth.at(x1, y1);
    const float jump = relative_depth_jump(z0, z1);
    const float length = x0 != x1 && y0 != y1 ? 1.4142136f : 1.0f;
    return colour + options.depth_weight * jump + options.length_weight * length;
  }
};

Image<float> geodesic_distance(const Image<float>& start, const GeodesicCost& cost) {
  using Item = std::pair<float, int>;
  Image<float> distance = start;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  for (int i = 0; i < static_cast<int>(start.size()); ++i)
    if (start.pixels()[i] < kFar) open.push({start.pixels()[i], i});
  while (!open.empty()) {
    const auto [d, i] = open.top();
    open.pop();
    if (d > distance.pixels()[i]) continue;
    const int x = i % start.width(), y = i / start.width();
    for (int ny = y - 1; ny <= y + 1; ++ny)
      for (int nx = x - 1; nx <= x + 1; ++nx) {
        if (!start.contains(nx, ny)) continue;
        const float next = d + cost(x, y, nx, ny);
        if (next >= distance.at(nx, ny)) continue;
        distance.at(nx, ny) = next;
        open.push({next, ny * start.width() + nx});
      }
  }
  return distance;
}

Image<float> sources(const Image<std::uint8_t>& seeds, std::uint8_t label, bool with_frame) {
  Image<float> start(seeds.width(), seeds.height(), kFar);
  for (int y = 0; y < seeds.height(); ++y)
    for (int x = 0; x < seeds.width(); ++x) {
      const bool frame = x == 0 || y == 0 || x == seeds.width() - 1 || y == seeds.height() - 1;
      if (seeds.at(x, y) == label || (with_frame && frame && seeds.at(x, y) == kNoSeed)) start.at(x, y) = 0;
    }
  return start;
}

// Mean contrast across the border of the pixels within `reach`, frame pixels counting as no contrast.
double border_contrast(const Image<float>& distance, float reach, const GeodesicCost& cost) {
  double contrast = 0;
  std::size_t pairs = 0;
  for (int y = 0; y < distance.height(); ++y)
    for (int x = 0; x < distance.width(); ++x) {
      if (distance.at(x, y) > reach) continue;
      for (const glm::ivec2& step : kFourSteps) {
        const glm::ivec2 q = glm::ivec2(x, y) + step;
        const bool inside = distance.contains(q.x, q.y);
        if (inside && distance.at(q.x, q.y) <= reach) continue;
        if (inside) contrast += std::min(kContrastCap, cost(x, y, q.x, q.y));
        ++pairs;
      }
    }
  return pairs ? contrast / static_cast<double>(pairs) : 0.0;
}

// Of the level sets of the distance, the one whose border lies best on edges of colour and depth.
float best_reach(const Image<float>& distance, const GeodesicCost& cost) {
  constexpr double kLeastArea = 0.002, kLargestArea = 0.4, kAreaStep = 1.12;
  std::vector<float> sorted(distance.pixels().begin(), distance.pixels().end());
  std::ranges::sort(sorted);
  const double pixels = static_cast<double>(sorted.size());
  float best = sorted[static_cast<std::size_t>(kLeastArea * pixels)];
  double most = 0;
  for (double area = kLeastArea; area < kLargestArea; area *= kAreaStep) {
    const float reach = sorted[static_cast<std::size_t>(area * pixels)];
    const double contrast = border_contrast(distance, reach, cost);
    if (contrast > most) {
      most = contrast;
      best = reach;
    }
  }
  return best;
}

Mask geodesic_prior(const Image<Rgb8>& picture, const Image<float>& depth, const Image<std::uint8_t>& seeds,
                    const FirstMaskOptions& options) {
  const cv::Mat lab = smooth_lab_of(picture);
  const GeodesicCost cost{lab, depth, options};
  Image<float> to_object = geodesic_distance(sources(seeds, kObjectSeed, false), cost);
  const Image<float> to_rest = geodesic_distance(sources(seeds, kRestSeed, true), cost);
  for (std::size_t i = 0; i < to_object.size(); ++i)
    if (to_object.pixels()[i] > to_rest.pixels()[i]) to_object.pixels()[i] = kFar;
  const float reach = best_reach(to_object, cost);
  Mask prior(seeds.width(), seeds.height());
  for (std::size_t i = 0; i < prior.size(); ++i)
    prior.pixels()[i] = to_object.pixels()[i] < kFar && to_object.pixels()[i] <= reach ? kMaskObject : 0;
  return prior;
}

// Regions of the mask that hold an object stroke.
Mask joined_to_strokes(const Mask& mask, const Image<std::uint8_t>& seeds) {
  cv::Mat region;
  const int regions = cv::connectedComponents(as_const_mat(mask), region, 8);
  std::vector<std::uint8_t> keep(static_cast<std::size_t>(regions), 0);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (mask.at(x, y) && seeds.at(x, y) == kObjectSeed) keep[region.at<int>(y, x)] = kMaskObject;
  Mask out(mask.width(), mask.height());
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) out.at(x, y) = mask.at(x, y) ? keep[region.at<int>(y, x)] : 0;
  return out;
}

}  // namespace

Mask first_mask(const Image<Rgb8>& picture, const Image<float>& depth, const Strokes& strokes,
                const FirstMaskOptions& options, const Job& job) {
  const Image<std::uint8_t> seeds = draw_seeds(strokes, picture.width(), picture.height());
  if (std::ranges::none_of(seeds.pixels(), [](std::uint8_t s) { return s == kObjectSeed; }))
    return Mask(picture.width(), picture.height());
  const Mask prior = geodesic_prior(picture, depth, seeds, options);
  if (job.cancelled()) return prior;
  const double size = std::sqrt(static_cast<double>(count(prior)));
  RefineOptions refine = options.refine;
  refine.band_px = std::max(2, static_cast<int>(0.06 * size));
  return joined_to_strokes(refine_mask(picture, depth, prior, refine, seeds), seeds);
}

}  // namespace splatcut
