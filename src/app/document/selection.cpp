#include "app/document/selection.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/ranks.h"
#include "scene/raster/depth_jump.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"
#include "segment/masks/seeds.h"

namespace splatcut {

namespace {

bool is_shown(std::span<const std::uint8_t> shown, std::size_t g) {
  return shown.empty() || shown[g];
}

template <class Keep>
Selection where(std::size_t gaussians, const Keep& keep) {
  Selection out(gaussians);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, gaussians, 16384), [&](const auto& range) {
    for (std::size_t g = range.begin(); g < range.end(); ++g) out[g] = keep(g) ? 1 : 0;
  });
  return out;
}

// True if more than half of the eight points at so many standard deviations along all axes lie inside.
template <class Inside>
bool most_inside(const GaussianCloud& cloud, std::size_t g, float deviations, const Inside& inside) {
  const glm::mat3 axes = glm::mat3_cast(cloud.rotation[g]);
  const glm::vec3 s = deviations * cloud.scale[g], &centre = cloud.position[g];
  const glm::vec3 x = s.x * axes[0], y = s.y * axes[1], z = s.z * axes[2];
  int in = 0;
  for (const float i : {-1.0f, 1.0f})
    for (const float j : {-1.0f, 1.0f})
      for (const float k : {-1.0f, 1.0f}) in += inside(centre + i * x + j * y + k * z);
  constexpr int kHalf = 4;
  return in > kHalf;
}

// A shape drawn around what one sees of a speck holds its core; the faint rim around that lies outside.
template <class Inside>
bool core_inside(const GaussianCloud& cloud, std::size_t g, const Inside& inside) {
  constexpr float kCore = 0.6f;  // deviations: the points hold about a third of what a picture shows of it
  return inside(cloud.position[g]) && most_inside(cloud, g, kCore, inside);
}

// True if what counts of the Gaussian lies inside.
template <class Inside>
bool is_taken(const GaussianCloud& cloud, std::size_t g, TakenBy by, const Inside& inside) {
  if (by == TakenBy::kCentre) return inside(cloud.position[g]);
  return most_inside(cloud, g, 1, inside) || core_inside(cloud, g, inside);
}

bool shows_in(const Mask& region, const Camera& camera, const glm::vec3& point_world) {
  const glm::vec3 point_camera = camera.camera_from_world(point_world);
  if (!(point_camera.z > 0)) return false;
  const glm::vec2 pixel = glm::floor(camera.pixel_from_camera(point_camera));
  // Compared as floats: a point beside the camera may lie farther away than an int counts.
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(region.width()) &&
        pixel.y < static_cast<float>(region.height())))
    return false;
  return region.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)) != 0;
}

// The value at a pixel of a picture of another size.
float value_at(const Image<float>& values, const Mask& of, int x, int y) {
  return values.at(x * values.width() / of.width(), y * values.height() / of.height());
}

// Returns the median length of the graph's arcs that begin at selected Gaussians.
float usual_spacing(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection) {
  std::vector<float> lengths;
  for (std::uint32_t g = 0; g < graph.nodes(); ++g) {
    if (!selection[g]) continue;
    for (std::uint32_t a = graph.first_arc[g]; a < graph.first_arc[g + 1]; ++a)
      lengths.push_back(glm::length(cloud.position[g] - cloud.position[graph.head[a]]));
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace

Mask polygon_region(std::span<const glm::vec2> corners_px, int width, int height) {
  Mask region(width, height);
  if (corners_px.size() < 3) return region;
  std::vector<float> crossings;
  for (int y = 0; y < height; ++y) {
    const float row = static_cast<float>(y) + 0.5f;
    crossings.clear();
    for (std::size_t i = 0; i < corners_px.size(); ++i) {
      const glm::vec2 a = corners_px[i], b = corners_px[(i + 1) % corners_px.size()];
      if ((a.y <= row) != (b.y <= row)) crossings.push_back(a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int x0 = std::max(0, static_cast<int>(std::ceil(crossings[i] - 0.5f)));
      const int x1 = std::min(width, static_cast<int>(std::ceil(crossings[i + 1] - 0.5f)));
      for (int x = x0; x < x1; ++x) region.at(x, y) = kMaskObject;
    }
  }
  return region;
}

Mask rectangle_region(const glm::vec2& a_px, const glm::vec2& b_px, int width, int height) {
  const glm::vec2 low = glm::min(a_px, b_px), high = glm::max(a_px, b_px);
  const glm::vec2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
  return polygon_region(corners, width, height);
}

Mask brush_region(std::span<const glm::vec2> path_px, float radius_px, int width, int height) {
  Mask region(width, height);
  Stroke stroke{SeedLabel::kObject, radius_px, {path_px.begin(), path_px.end()}};
  const Image<std::uint8_t> seeds = draw_seeds({stroke}, width, height);
  std::ranges::transform(seeds.pixels(), region.pixels().begin(),
                         [](std::uint8_t s) { return s == kObjectSeed ? kMaskObject : std::uint8_t{0}; });
  return region;
}

Mask surface_region(const Mask& region, std::span<const glm::vec2> path_px, const Image<float>& depth) {
  Mask out(region.width(), region.height());
  const Mask path = brush_region(path_px, 0.5f, region.width(), region.height());
  std::vector<glm::ivec2> open;
  const auto reach = [&](const glm::ivec2& at) {
    out.at(at.x, at.y) = kMaskObject;
    open.push_back(at);
  };
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x)
      if (path.at(x, y) && region.at(x, y)) reach({x, y});
  while (!open.empty()) {
    const glm::ivec2 from = open.back();
    open.pop_back();
    const float z = value_at(depth, region, from.x, from.y);
    for (const glm::ivec2& step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      const glm::ivec2 to = from + step;
      if (!region.contains(to.x, to.y) || !region.at(to.x, to.y) || out.at(to.x, to.y)) continue;
      const float next = value_at(depth, region, to.x, to.y);
      if (relative_depth_jump(z, next) <= kJumpUnderBrush) reach(to);
    }
  }
  return out;
}

Selection select_visible(const GaussianCloud& cloud, const Camera& camera, const Mask& region,
                         std::span<const std::uint8_t> shown, TakenBy by, const Job& job) {
  MaskedSums sums(cloud.size());
  RasterOptions options;
  options.colour = false;
  options.shown = shown;
  options.sum_mask = &region;
  options.sums = &sums;
  rasterize(cloud, camera, options, job);
  constexpr double kLeastPixels = 0.02;  // a Gaussian with less counts as invisible
  const auto least = static_cast<std::int64_t>(kLeastPixels * MaskedSums::kUnitsPerPixel);
  return where(cloud.size(), [&](std::size_t g) {
    if (by == TakenBy::kCentre) return sums.total[g] >= least && shows_in(region, camera, cloud.position[g]);
    return sums.inside[g] >= least && 2 * sums.inside[g] > sums.total[g];
  });
}

Selection select_through(const GaussianCloud& cloud, const Camera& camera, const Mask& region,
                         std::span<const std::uint8_t> shown, const SeeThroughOptions& options) {
  return where(cloud.size(), [&](std::size_t g) {
    if (!is_shown(shown, g)) return false;
    if (!is_taken(cloud, g, options.by, [&](const glm::vec3& p) { return shows_in(region, camera, p); }))
      return false;
    if (!options.surface_depth || std::isinf(options.depth_limit)) return true;
    // The centre of a footprint may lie beside the picture: its border stands for that.
    const glm::vec3 point_camera = camera.camera_from_world(cloud.position[g]);
    if (!(point_camera.z > 0)) return true;
    const glm::vec2 most(region.width() - 1, region.height() - 1);
    const glm::vec2 pixel = glm::clamp(camera.pixel_from_camera(point_camera), glm::vec2(0), most);
    const float surface =
        value_at(*options.surface_depth, region, static_cast<int>(pixel.x), static_cast<int>(pixel.y));
    return surface <= 0 || point_camera.z <= surface + options.depth_limit;
  });
}

Selection select_volume(const GaussianCloud& cloud, const Volume& volume, std::span<const std::uint8_t> shown,
                        TakenBy by) {
  return where(cloud.size(), [&](std::size_t g) {
    return is_shown(shown, g) &&
           is_taken(cloud, g, by, [&](const glm::vec3& p) { return inside(volume, p); });
  });
}

glm::vec3 base_colour(const GaussianCloud& cloud, std::size_t g) {
  return glm::clamp(0.5f + kShC0 * cloud.f_dc[g], 0.0f, 1.0f);
}

Selection select_colour(const GaussianCloud& cloud, const glm::vec3& colour, float tolerance) {
  return where(cloud.size(), [&](std::size_t g) {
    const glm::vec3 d = glm::abs(base_colour(cloud, g) - colour);
    return std::max({d.r, d.g, d.b}) <= tolerance;
  });
}

Selection select_flood(const GaussianCloud& cloud, const FlowGraph& graph, std::size_t start, float tolerance,
                       std::span<const std::uint8_t> shown) {
  const glm::vec3 wanted = base_colour(cloud, start);
  const auto alike = [&](std::uint32_t g) {
    const glm::vec3 d = glm::abs(base_colour(cloud, g) - wanted);
    return is_shown(shown, g) && std::max({d.r, d.g, d.b}) <= tolerance;
  };
  Selection out(cloud.size(), 0);
  std::vector<std::uint32_t> open{static_cast<std::uint32_t>(start)};
  out[start] = 1;
  while (!open.empty()) {
    const std::uint32_t g = open.back();
    open.pop_back();
    for (std::uint32_t a = graph.first_arc[g]; a < graph.first_arc[g + 1]; ++a) {
      const std::uint32_t h = graph.head[a];
      if (out[h] || !alike(h)) continue;
      out[h] = 1;
      open.push_back(h);
    }
  }
  return out;
}

std::vector<float> property_values(const GaussianCloud& cloud, Property property, const Camera* camera) {
  assert(property != Property::kDepth || camera);
  std::vector<float> values(cloud.size());
  for (std::size_t g = 0; g < values.size(); ++g) {
    if (property == Property::kOpacity) values[g] = cloud.opacity[g];
    if (property == Property::kDepth) values[g] = camera->camera_from_world(cloud.position[g]).z;
    if (property == Property::kSize) {
      const glm::vec3& s = cloud.scale[g];
      values[g] = std::log10(std::max({s.x, s.y, s.z, 1e-20f}));
    }
    if (property == Property::kNeedle) {
      const glm::vec3& s = cloud.scale[g];
      const float longest = std::max({s.x, s.y, s.z}), shortest = std::min({s.x, s.y, s.z});
      const float middle = s.x + s.y + s.z - longest - shortest;
      values[g] = longest > 0 ? longest / std::max(middle, 1e-4f * longest) : 1;
    }
  }
  return values;
}

Selection select_range(std::span<const float> values, float low, float high) {
  return where(values.size(), [&](std::size_t g) { return values[g] >= low && values[g] <= high; });
}

Histogram histogram(std::span<const float> values, int bins) {
  Histogram out;
  out.share.assign(static_cast<std::size_t>(bins), 0);
  if (values.empty()) return out;
  std::vector<float> by_rank(values.begin(), values.end());
  out.low = quantile(&by_rank, 0.001);
  out.high = std::max(quantile(&by_rank, 0.999), out.low + 1e-6f);
  for (const float v : values) {
    const float t = (v - out.low) / (out.high - out.low) * static_cast<float>(bins);
    if (t >= 0 && t <= static_cast<float>(bins))
      ++out.share[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>(t)))];
  }
  const float fullest = *std::ranges::max_element(out.share);
  for (float& s : out.share) s /= std::max(1.0f, fullest);
  return out;
}

Selection grown(const FlowGraph& graph, const Selection& selection) {
  return where(selection.size(), [&](std::size_t g) {
    if (selection[g]) return true;
    for (std::uint32_t a = graph.first_arc[g]; a < graph.first_arc[g + 1]; ++a)
      if (selection[graph.head[a]]) return true;
    return false;
  });
}

Selection shrunk(const FlowGraph& graph, const Selection& selection) {
  return where(selection.size(), [&](std::size_t g) {
    if (!selection[g]) return false;
    for (std::uint32_t a = graph.first_arc[g]; a < graph.first_arc[g + 1]; ++a)
      if (!selection[graph.head[a]]) return false;
    return true;
  });
}

namespace {

// Standard deviation along a unit direction.
float deviation_along(const GaussianCloud& cloud, std::size_t g, const glm::vec3& direction) {
  return glm::length(cloud.scale[g] * (glm::conjugate(cloud.rotation[g]) * direction));
}

// True if the ellipsoids of one standard deviation lie no farther apart along the line between the centres.
bool within_gap(const GaussianCloud& cloud, std::size_t g, std::size_t h, float gap) {
  const glm::vec3 apart = cloud.position[h] - cloud.position[g];
  const float distance = glm::length(apart);
  if (distance <= gap) return true;
  const glm::vec3 direction = apart / distance;
  return distance - deviation_along(cloud, g, direction) - deviation_along(cloud, h, direction) <= gap;
}

}  // namespace

Parts connected_parts(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection,
                      float most_gap) {
  constexpr std::int32_t kNotYet = -2;
  Parts parts;
  parts.part.assign(selection.size(), -1);
  for (std::size_t g = 0; g < selection.size(); ++g)
    if (selection[g]) parts.part[g] = kNotYet;
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < selection.size(); ++start) {
    if (parts.part[start] != kNotYet) continue;
    const auto number = static_cast<std::int32_t>(parts.size.size());
    parts.size.push_back(0);
    parts.part[start] = number;
    open.assign(1, start);
    while (!open.empty()) {
      const std::uint32_t g = open.back();
      open.pop_back();
      ++parts.size.back();
      for (std::uint32_t a = graph.first_arc[g]; a < graph.first_arc[g + 1]; ++a) {
        const std::uint32_t h = graph.head[a];
        if (parts.part[h] != kNotYet || !within_gap(cloud, g, h, most_gap)) continue;
        parts.part[h] = number;
        open.push_back(h);
      }
    }
  }
  // The largest first; equal sizes keep the order of their first Gaussian.
  std::vector<std::int32_t> order(parts.size.size()), rank(parts.size.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](auto a, auto b) {
    return parts.size[static_cast<std::size_t>(a)] > parts.size[static_cast<std::size_t>(b)];
  });
  std::vector<std::size_t> sizes(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
    sizes[i] = parts.size[static_cast<std::size_t>(order[i])];
  }
  for (std::int32_t& p : parts.part)
    if (p >= 0) p = rank[static_cast<std::size_t>(p)];
  parts.size = std::move(sizes);
  return parts;
}

Selection largest_part(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection) {
  const Parts parts = connected_parts(cloud, graph, selection);
  return where(selection.size(), [&](std::size_t g) { return parts.part[g] == 0; });
}

Selection floaters(const GaussianCloud& cloud, const FlowGraph& graph, const Selection& selection,
                   const FloaterOptions& options) {
  const float most_gap = options.gap_spacings * usual_spacing(cloud, graph, selection);
  const Parts parts = connected_parts(cloud, graph, selection, most_gap);
  const double most = options.most_share * static_cast<double>(count_if(selection.begin(), selection.end(),
                                                                        [](auto s) { return s != 0; }));
  return where(selection.size(), [&](std::size_t g) {
    const std::int32_t p = parts.part[g];
    return p > 0 && static_cast<double>(parts.size[static_cast<std::size_t>(p)]) <= most;
  });
}

Selection combined(std::span<const std::uint8_t> before, std::span<const std::uint8_t> region,
                   SetOperation operation) {
  assert(before.size() == region.size());
  return where(before.size(), [&](std::size_t g) {
    switch (operation) {
      case SetOperation::kAdd:
        return before[g] || region[g];
      case SetOperation::kRemove:
        return before[g] && !region[g];
      case SetOperation::kIntersect:
        return before[g] && region[g];
    }
    return false;
  });
}

}  // namespace splatcut
