#include "segment/masks/refine_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "scene/raster/depth_jump.h"
#include "segment/graphcut/max_flow.h"
#include "segment/masks/cv_image.h"
#include "segment/masks/mask_tools.h"
#include "segment/masks/seeds.h"

namespace splatcut {

namespace {

enum Side : std::uint8_t {
  kSureRest = cv::GC_BGD,
  kSureObject = cv::GC_FGD,
  kMaybeRest = cv::GC_PR_BGD,
  kMaybeObject = cv::GC_PR_FGD
};

bool is_object(std::uint8_t side) {
  return side & 1;
}
bool is_sure(std::uint8_t side) {
  return side < 2;
}

Image<std::uint8_t> trimap_of(const Mask& prior, const PixelRect& rect, const RefineOptions& options,
                              const Image<std::uint8_t>& seeds) {
  Image<std::uint8_t> trimap(prior.width(), prior.height(), kSureRest);
  const Mask core = eroded(prior, options.band_px), reach = dilated(prior, options.band_px + options.grow_px);
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) {
      std::uint8_t& t = trimap.at(x, y);
      t = core.at(x, y)     ? kSureObject
          : !reach.at(x, y) ? kSureRest
          : prior.at(x, y)  ? kMaybeObject
                            : kMaybeRest;
      if (!seeds.empty() && seeds.at(x, y) != kNoSeed)
        t = seeds.at(x, y) == kObjectSeed ? kSureObject : kSureRest;
    }
  return trimap;
}

cv::Mat grab_cut(const Image<Rgb8>& picture, const cv::Mat& trimap, const PixelRect& rect, int iterations) {
  cv::Mat labels = trimap.clone(), rest_model, object_model;
  cv::setRNGSeed(1);  // grabCut's k-means draws from a global generator
  cv::grabCut(as_const_mat(picture)(as_rect(rect)), labels, {}, rest_model, object_model, iterations,
              cv::GC_INIT_WITH_MASK);
  return labels;
}

// Colours of the two sides, counted into 12^3 bins of Lab and blurred: a few hundred pixels must do.
class ColourModel {
 public:
  ColourModel(const cv::Mat& lab, const cv::Mat& sides) : bin_(lab.size(), CV_32SC1) {
    std::array<std::vector<float>, 2> count{std::vector<float>(kBins * kBins * kBins),
                                            std::vector<float>(kBins * kBins * kBins)};
    for (int y = 0; y < lab.rows; ++y)
      for (int x = 0; x < lab.cols; ++x) {
        const auto& c = lab.at<cv::Vec3f>(y, x);
        const int bin =
            (index(c[0] / 100) * kBins + index((c[1] + 80) / 160)) * kBins + index((c[2] + 80) / 160);
        bin_.at<int>(y, x) = bin;
        count[is_object(sides.at<std::uint8_t>(y, x))][static_cast<std::size_t>(bin)] += 1;
      }
    std::array<double, 2> sum{0, 0};
    for (int side = 0; side < 2; ++side) {
      count[side] = blurred(count[side]);
      for (float& c : count[side]) sum[side] += c += 1e-3f;
    }
    ratio_.resize(count[0].size());
    for (std::size_t i = 0; i < ratio_.size(); ++i)
      ratio_[i] = std::clamp(static_cast<float>(std::log(count[1][i] / sum[1] * sum[0] / count[0][i])),
                             -kMostCertain, kMostCertain);
  }
  float log_ratio(int x, int y) const { return ratio_[static_cast<std::size_t>(bin_.at<int>(y, x))]; }

 private:
  static constexpr int kBins = 12;
  static constexpr float kMostCertain = 4;
  static int index(float share) { return std::clamp(static_cast<int>(share * kBins), 0, kBins - 1); }
  static std::vector<float> blurred(std::vector<float> values) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{kBins}, std::size_t{kBins} * kBins}) {
      const std::vector<float> from = values;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t at = i / step % kBins;
        values[i] =
            0.5f * from[i] + 0.25f * ((at > 0 ? from[i - step] : 0) + (at + 1 < kBins ? from[i + step] : 0));
      }
    }
    return values;
  }
  cv::Mat bin_;
  std::vector<float> ratio_;
};

// Signed distance to the prior's border over the band: -1 well outside, +1 well inside.
cv::Mat side_of_prior(const Mask& prior, const PixelRect& rect, int band_px) {
  const cv::Mat object = as_const_mat(prior)(as_rect(rect));
  cv::Mat inside, outside;
  cv::distanceTransform(object, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(object == 0, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat side = (inside - outside) / static_cast<double>(std::max(1, band_px));
  cv::min(side, 1.0, side);
  cv::max(side, -1.0, side);
  return side;
}

// The pixels that may change side. Edges to fixed pixels become terminal weights of their neighbours.
struct Grid {
  std::vector<cv::Point> pixel;    // per node, row by row
  std::vector<std::int64_t> pull;  // per node: of sure neighbours, > 0 towards the object
  FlowGraph graph;
  std::vector<std::int32_t> capacity;  // per arc
};

constexpr float kScale = 1 << 12;

// Calls visit(pixel, neighbour, |dLab|^2) for each pair of the 8-grid.
template <class Visit>
void for_pairs(const cv::Mat& lab, const Visit& visit) {
  for (int y = 0; y < lab.rows; ++y)
    for (int x = 0; x < lab.cols; ++x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
        if (x + dx < 0 || x + dx >= lab.cols || y + dy >= lab.rows) continue;
        const cv::Vec3f d = lab.at<cv::Vec3f>(y, x) - lab.at<cv::Vec3f>(y + dy, x + dx);
        visit(cv::Point(x, y), cv::Point(x + dx, y + dy), d.dot(d));
      }
}

Grid grid_of(const cv::Mat& lab, const Image<float>& depth, const cv::Mat& trimap, const PixelRect& rect,
             const RefineOptions& options) {
  double sum = 0;
  std::size_t pairs = 0;
  for_pairs(lab, [&](cv::Point, cv::Point, float colour) {
    sum += colour;
    ++pairs;
  });
  const float mean = static_cast<float>(sum / static_cast<double>(std::max<std::size_t>(1, pairs)));
  Grid grid;
  Image<std::int32_t> node(lab.cols, lab.rows, -1);
  for (int y = 0; y < lab.rows; ++y)
    for (int x = 0; x < lab.cols; ++x) {
      if (is_sure(trimap.at<std::uint8_t>(y, x))) continue;
      node.at(x, y) = static_cast<std::int32_t>(grid.pixel.size());
      grid.pixel.emplace_back(x, y);
    }
  grid.pull.resize(grid.pixel.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<std::int32_t> weight;
  for_pairs(lab, [&](cv::Point p, cv::Point q, float colour) {
    const std::int32_t a = node.at(p.x, p.y), b = node.at(q.x, q.y);
    if (a < 0 && b < 0) return;
    const float z0 = depth.at(rect.x0 + p.x, rect.y0 + p.y), z1 = depth.at(rect.x0 + q.x, rect.y0 + q.y);
    const float jump = relative_depth_jump(z0, z1);
    const float most = options.lambda * std::exp(-options.depth_weight * jump) /
                       (p.x != q.x && p.y != q.y ? 1.4142136f : 1.0f);
    const auto c =
        static_cast<std::int32_t>(kScale * most * std::exp(-colour / std::max(2 * mean, 1e-6f)) + 0.5f);
    if (a < 0 || b < 0) {
      grid.pull[static_cast<std::size_t>(std::max(a, b))] +=
          is_object(trimap.at<std::uint8_t>(a < 0 ? p : q)) ? c : -c;
      return;
    }
    edges.emplace_back(a, b);
    weight.push_back(c);
  });
  std::vector<std::uint32_t> arc_of_edge;
  grid.graph = graph_from_edges(grid.pixel.size(), edges, &arc_of_edge);
  grid.capacity.resize(grid.graph.arcs());
  for (std::size_t e = 0; e < edges.size(); ++e)
    grid.capacity[arc_of_edge[e]] = grid.capacity[grid.graph.reverse_arc[arc_of_edge[e]]] = weight[e];
  return grid;
}

// unary: of a pixel of the rectangle, natural logarithms, > 0 for the object.
template <class Unary>
void solve(const Grid& grid, const Unary& unary, MaxFlow* flow, cv::Mat* labels) {
  for (std::uint32_t n = 0; n < grid.pixel.size(); ++n)
    flow->set_terminal(n,
                       static_cast<std::int64_t>(std::lround(kScale * unary(grid.pixel[n]))) + grid.pull[n]);
  flow->solve();
  for (std::uint32_t n = 0; n < grid.pixel.size(); ++n)
    labels->at<std::uint8_t>(grid.pixel[n]) = flow->source_side(n) ? kMaybeObject : kMaybeRest;
}

// labels: of the rectangle; outside of it is the rest. Of the prior's size.
Mask mask_of(const cv::Mat& labels, const PixelRect& rect, const Mask& prior) {
  Mask out(prior.width(), prior.height());
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x)
      out.at(x, y) = is_object(labels.at<std::uint8_t>(y - rect.y0, x - rect.x0)) ? kMaskObject : 0;
  return out;
}

cv::Mat pixel_cut(const Image<Rgb8>& picture, const Image<float>& depth, const Mask& prior,
                  const cv::Mat& trimap, const PixelRect& rect, const RefineOptions& options) {
  const cv::Mat lab = lab_of(as_const_mat(picture)(as_rect(rect)));
  const Grid grid = grid_of(lab, depth, trimap, rect, options);
  const cv::Mat side = side_of_prior(prior, rect, options.band_px + options.grow_px);
  cv::Mat labels = trimap.clone();
  MaxFlow flow(grid.graph, grid.capacity);
  for (int i = 0; i < options.iterations; ++i) {
    const ColourModel model(lab, labels);
    solve(
        grid,
        [&](cv::Point p) { return model.log_ratio(p.x, p.y) + options.prior_weight * side.at<float>(p); },
        &flow, &labels);
  }
  return labels;
}

}  // namespace

Mask refine_mask(const Image<Rgb8>& picture, const Image<float>& depth, const Mask& prior,
                 const RefineOptions& options, const Image<std::uint8_t>& seeds) {
  const PixelRect object = bounds(prior);
  if (object.empty() || options.iterations == 0 || options.solver == MaskSolver::kNone) return prior;
  const PixelRect rect =
      grown(object, 2 * options.band_px + options.grow_px + 4, prior.width(), prior.height());
  Image<std::uint8_t> trimap = trimap_of(prior, rect, options, seeds);
  const cv::Mat sides = as_mat(trimap)(as_rect(rect));
  const auto object_pixels = cv::countNonZero(sides & 1),
             rest_pixels = static_cast<int>(sides.total()) - object_pixels;
  constexpr int kMixtureComponents = 5;  // OpenCV's k-means asserts below this many samples
  if (object_pixels < 2 * kMixtureComponents || rest_pixels < 2 * kMixtureComponents) return prior;
  const cv::Mat labels = options.solver == MaskSolver::kGrabCut
                             ? grab_cut(picture, sides, rect, options.iterations)
                             : pixel_cut(picture, depth, prior, sides, rect, options);
  return mask_of(labels, rect, prior);
}

Mask cut_by_odds(const Image<Rgb8>& picture, const Image<float>& depth, const Mask& prior,
                 const Image<float>& log_odds, const RefineOptions& options) {
  const PixelRect object = bounds(prior);
  if (object.empty()) return prior;
  const PixelRect rect = grown(object, options.band_px + 1, prior.width(), prior.height());
  const cv::Mat side = side_of_prior(prior, rect, options.band_px);
  cv::Mat labels(side.size(), CV_8UC1);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const float s = side.at<float>(y, x);
      labels.at<std::uint8_t>(y, x) = s >= 1    ? kSureObject
                                      : s <= -1 ? kSureRest
                                      : s > 0   ? kMaybeObject
                                                : kMaybeRest;
    }
  const Grid grid = grid_of(lab_of(as_const_mat(picture)(as_rect(rect))), depth, labels, rect, options);
  MaxFlow flow(grid.graph, grid.capacity);
  solve(
      grid, [&](cv::Point p) { return log_odds.at(rect.x0 + p.x, rect.y0 + p.y); }, &flow, &labels);
  return mask_of(labels, rect, prior);
}

}  // namespace splatcut
