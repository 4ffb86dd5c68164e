#include "segment/finish/carve.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kFarPx = 2;
constexpr double kFarShare = 0.05;

// Planes of PlaneSums: ones, positions in units of the picture's width from its middle.
enum Plane : std::size_t { kAll, kInside, kFar, kX, kY, kInsideX, kInsideY, kPlanes };

std::vector<Image<float>> planes_of(const OwnView& view, std::size_t count) {
  std::vector<Image<float>> planes(count, Image<float>(view.rect.width(), view.rect.height()));
  const Mask near = dilated(view.inside, kFarPx);
  const float unit = 1 / static_cast<float>(view.camera.width_px);
  for (int y = 0; y < view.rect.height(); ++y)
    for (int x = 0; x < view.rect.width(); ++x) {
      if (!view.valid.at(x, y)) continue;
      const bool inside = view.inside.at(x, y) != 0;
      const auto set = [&](Plane plane, float value) {
        if (plane < count) planes[plane].at(x, y) = value;
      };
      const float u = (static_cast<float>(x + view.rect.x0) + 0.5f - view.camera.cx_px) * unit,
                  v = (static_cast<float>(y + view.rect.y0) + 0.5f - view.camera.cy_px) * unit;
      set(kAll, 1);
      set(kInside, inside ? 1.0f : 0.0f);
      set(kFar, near.at(x, y) ? 0.0f : 1.0f);
      set(kX, u);
      set(kY, v);
      if (inside) set(kInsideX, u), set(kInsideY, v);
    }
  return planes;
}

void add_sums(const OwnView& view, const GaussianCloud& object, const std::vector<std::uint8_t>& kept,
              PlaneSums* sums, const Job& job) {
  const std::vector<Image<float>> planes = planes_of(view, sums->planes());
  RasterOptions raster;
  raster.colour = false;
  raster.roi = view.rect;
  raster.shown = kept;
  raster.sum_planes = planes;
  raster.plane_sums = sums;
  rasterize(object, view.camera, raster, job);
}

double share_inside(const PlaneSums& sums, std::size_t g) {
  const double all = sums.at(g, kAll);
  return all > 0 ? sums.at(g, kInside) / all : 1;
}

bool sticks_out(const PlaneSums& sums, std::size_t g, double least_px) {
  const double all = sums.at(g, kAll);
  return all > least_px && sums.at(g, kFar) > kFarShare * all;
}

// From the outer part's middle to the inner part's, px; zero where either is nothing.
glm::dvec2 inwards_px(const OwnView& view, const PlaneSums& sums, std::size_t g) {
  const double inside = sums.at(g, kInside), outside = sums.at(g, kAll) - inside;
  if (!(inside > 0) || !(outside > 0)) return {0, 0};
  const glm::dvec2 within(sums.at(g, kInsideX), sums.at(g, kInsideY)), all(sums.at(g, kX), sums.at(g, kY));
  return (within / inside - (all - within) / outside) * static_cast<double>(view.camera.width_px);
}

// The direction in the world across which the border runs: the picture's line, seen through Sigma2.
glm::vec3 normal_of(const OwnView& view, const GaussianCloud& object, std::size_t g,
                    const glm::dvec2& in_px) {
  const glm::vec3 at = view.camera.camera_from_world(object.position[g]);
  const Symmetric2 s = covariance_px2(view.camera, at, covariance_world(object.scale[g], object.rotation[g]));
  const auto x = static_cast<float>(in_px.x), y = static_cast<float>(in_px.y);
  const auto [row_x, row_y] = pixel_jacobian(view.camera, at);
  return (s.c * x - s.b * y) * row_x + (s.a * y - s.b * x) * row_y;  // by Sigma2^-1, up to a factor
}

// Per Gaussian of the object whether the scene hides its middle in all views, and in more than a quarter of
// those that hold it what hides it is not the object.
std::vector<std::uint8_t> hidden_beside(std::span<const OwnView> views, const GaussianCloud& object) {
  constexpr float kBehind = 1.02f, kMarginOfObject = 0.02f;
  constexpr int kOneIn = 4;
  struct Count {
    int held = 0, beside = 0, seen = 0;
  };
  std::vector<Count> counts(object.size());
  for (const OwnView& view : views) {
    const auto side = static_cast<float>(std::max(view.rect.width(), view.rect.height()));
    const Mask near = dilated(view.inside, kFarPx + static_cast<int>(kMarginOfObject * side));
    for_each_index(object.size(), [&](std::size_t g) {
      const glm::vec3 at = view.camera.camera_from_world(object.position[g]);
      if (at.z <= near_plane_for(object, view.camera)) return;
      const glm::vec2 px = view.camera.pixel_from_camera(at) - glm::vec2(view.rect.x0, view.rect.y0);
      const glm::vec2 size(near.width(), near.height());
      if (!(px.x >= 0 && px.y >= 0 && px.x < size.x && px.y < size.y)) return;
      const auto x = static_cast<int>(px.x), y = static_cast<int>(px.y);
      ++counts[g].held;
      counts[g].beside += near.at(x, y) == 0;
      const float surface = view.depth.at(x, y);  // 0: there is nothing
      counts[g].seen += !(surface > 0) || at.z < kBehind * surface;
    });
  }
  std::vector<std::uint8_t> hidden(object.size());
  std::ranges::transform(counts, hidden.begin(),
                         [](const Count& c) { return c.seen == 0 && kOneIn * c.beside > c.held; });
  return hidden;
}

SolidGaussian one_of(const GaussianCloud& cloud, std::size_t g) {
  return {cloud.position[g], cloud.scale[g], cloud.rotation[g], cloud.opacity[g]};
}

// The inner part stays in the object; returns the outer one.
std::optional<SolidGaussian> split(const OwnView& view, const PlaneSums& sums, std::size_t g,
                                   GaussianCloud* object) {
  const glm::dvec2 in_px = inwards_px(view, sums, g);
  if (in_px == glm::dvec2(0, 0)) return {};
  const SolidGaussian whole = one_of(*object, g);
  const glm::vec3 normal = normal_of(view, *object, g, in_px);
  const double inside = share_inside(sums, g);
  const SolidGaussian half = half_gaussian(whole, normal, inside);
  object->position[g] = half.mean;
  object->scale[g] = half.scale;
  object->rotation[g] = half.rotation;
  object->opacity[g] = half.opacity;
  return half_gaussian(whole, -normal, 1 - inside);
}

}  // namespace

CarveReport carve(std::span<const OwnView> views, GaussianCloud* object, std::vector<std::uint8_t>* kept,
                  const Job& job) {
  constexpr double kLeastPx = 0.3, kMostlyOut = 0.5, kSliver = 0.05, kWhole = 0.93, kMostlyIn = 0.75;
  const std::size_t n = object->size();
  PlaneSums pooled(n, kFar + 1);
  for (const OwnView& view : views) add_sums(view, *object, *kept, &pooled, job);
  CarveReport report;
  std::vector<std::uint8_t> was_split(n, 0);
  std::vector<std::optional<SolidGaussian>> outer(n);
  const std::vector<std::uint8_t> before = *kept, hidden = hidden_beside(views, *object);
  for (std::size_t g = 0; g < n; ++g)
    if (hidden[g] || (sticks_out(pooled, g, 0) && share_inside(pooled, g) < kMostlyOut)) (*kept)[g] = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (job.cancelled()) return {};
    job.progress("clean edges", static_cast<double>(v) / static_cast<double>(views.size()));
    PlaneSums sums(n, kPlanes);
    add_sums(views[v], *object, *kept, &sums, job);
    for_each_index(n, [&](std::size_t g) {
      if (!(*kept)[g] || !sticks_out(sums, g, kLeastPx)) return;
      const double inside = share_inside(sums, g);
      if (inside < kSliver) {
        if (share_inside(pooled, g) < kMostlyIn) (*kept)[g] = 0;
      } else if (inside < kWhole) {
        outer[g] = split(views[v], sums, g, object);
        was_split[g] = 1;
      }
    });
    for (std::uint32_t g = 0; g < n; ++g)
      if (const auto part = std::exchange(outer[g], {})) report.cut_off.push_back({g, *part});
  }
  for (std::uint32_t g = 0; g < n; ++g) {
    report.split += (*kept)[g] && was_split[g];
    if (!before[g] || (*kept)[g]) continue;
    ++report.left;
    report.cut_off.push_back({g, one_of(*object, g)});
  }
  return report;
}

}  // namespace splatcut
