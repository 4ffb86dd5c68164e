#include "scene/raster/guessed_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

// A Gaussian as a disc.
struct Disc {
  glm::vec3 centre, normal;
  float area;  // sigma^2
};

std::vector<Disc> sampled_discs(const GaussianCloud& cloud) {
  constexpr std::size_t kSample = 1 << 16;
  constexpr float kLeastOpacity = 0.1f;
  constexpr double kAreaQuantile = 0.985;  // sky and haze are huge, and no ground
  const Box box = robust_bounds(cloud.position, 0.96);
  std::vector<Disc> discs;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSample);
  for (std::size_t g = 0; g < cloud.size(); g += step) {
    const glm::vec3 p = cloud.position[g], s = cloud.scale[g];
    if (cloud.opacity[g] < kLeastOpacity || glm::any(glm::lessThan(p, box.min)) ||
        glm::any(glm::greaterThan(p, box.max)))
      continue;
    const int thin = s.x <= s.y && s.x <= s.z ? 0 : s.y <= s.z ? 1 : 2;
    discs.push_back({p, glm::mat3_cast(cloud.rotation[g])[thin], s[(thin + 1) % 3] * s[(thin + 2) % 3]});
  }
  if (discs.empty()) return discs;
  std::vector<float> areas;
  for (const Disc& d : discs) areas.push_back(d.area);
  const auto high =
      areas.begin() + static_cast<std::ptrdiff_t>(kAreaQuantile * static_cast<double>(areas.size() - 1));
  std::ranges::nth_element(areas, high);
  std::erase_if(discs, [&](const Disc& d) { return d.area > *high; });
  return discs;
}

double prior_of(const glm::vec3& up) {
  if (up.y < -0.5f) return 1.3;
  if (up.z > 0.5f) return 1.2;
  if (up.y > 0.5f) return 1.0;
  return up.z < -0.5f ? 0.6 : 0.4;
}

// Areas in slabs across `axis`, from its low end to its high one.
struct Slabs {
  static constexpr int kCount = 32;
  std::array<double, kCount> level{}, standing{};
};

Slabs slabs_along(const std::vector<Disc>& discs, int axis) {
  constexpr float kLevel = 0.906f;  // cosine of 25 degrees
  const auto [low, high] = std::ranges::minmax(discs, {}, [&](const Disc& d) { return d.centre[axis]; });
  const float from = low.centre[axis], extent = std::max(1e-30f, high.centre[axis] - from);
  Slabs slabs;
  double all = 0;
  for (const Disc& d : discs) {
    const int slab =
        std::min(Slabs::kCount - 1, static_cast<int>((d.centre[axis] - from) / extent * Slabs::kCount));
    (std::abs(d.normal[axis]) > kLevel ? slabs.level : slabs.standing)[static_cast<std::size_t>(slab)] +=
        d.area;
    all += d.area;
  }
  for (auto* areas : {&slabs.level, &slabs.standing})
    for (double& a : *areas) a /= std::max(1e-30, all);
  return slabs;
}

double ground_score(Slabs slabs, bool upwards) {
  if (!upwards) {
    std::ranges::reverse(slabs.level);
    std::ranges::reverse(slabs.standing);
  }
  double best = 0;
  for (int s = 0; s < Slabs::kCount; ++s) {
    const auto sum = [](const std::array<double, Slabs::kCount>& areas, int begin, int end) {
      double area = 0;
      for (int i = std::max(0, begin); i < std::min(Slabs::kCount, end); ++i)
        area += areas[static_cast<std::size_t>(i)];
      return area;
    };
    const double ground =
        sum(slabs.level, s - 1, s + 2);  // a slab's neighbours: it need not lie on their border
    const double above = sum(slabs.standing, s + 1, s + 1 + Slabs::kCount / 2);
    const double below = sum(slabs.standing, 0, s - 1) + sum(slabs.level, 0, s - 1);
    best = std::max(best, ground * (above - below));
  }
  return best;
}

// How well a view shows the scene: sharp share of the picture, and of what is covered.
struct Sharpness {
  double of_picture = 0, of_covered = 0;
  float median_depth = 0;
};

Sharpness sharpness(const GaussianCloud& cloud, const Camera& view, const Job& job) {
  constexpr float kSharpPx = 1.5f;
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  const Camera camera = limited_to_width(view, 160);
  const RasterOutput out = rasterize(cloud, camera, options, job);
  Sharpness s;
  std::vector<float> depths;
  for (std::size_t i = 0; i < out.first_hit.size(); ++i) {
    const std::int32_t g = out.first_hit.pixels()[i];
    if (g < 0) continue;
    const float depth = out.median_depth.pixels()[i];
    glm::vec3 scale = cloud.scale[static_cast<std::size_t>(g)];
    std::sort(&scale.x, &scale.x + 3);
    const float px = scale.y * camera.fx_px / depth / kSharpPx;
    s.of_covered += 1 / (1 + px * px);
    depths.push_back(depth);
  }
  if (depths.empty()) return s;
  s.of_picture = s.of_covered / static_cast<double>(out.first_hit.size());
  s.of_covered /= static_cast<double>(depths.size());
  const auto middle = depths.begin() + std::ssize(depths) / 2;
  std::ranges::nth_element(depths, middle);
  s.median_depth = *middle;
  return s;
}

}  // namespace

glm::vec3 guessed_up(const GaussianCloud& cloud) {
  glm::vec3 best(0, -1, 0);
  const std::vector<Disc> discs = sampled_discs(cloud);
  if (discs.empty()) return best;
  double best_score = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Slabs slabs = slabs_along(discs, axis);
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec3 up(0);
      up[axis] = sign;
      const double score = prior_of(up) * ground_score(slabs, sign > 0);
      if (score > best_score) best_score = score, best = up;
    }
  }
  return best;
}

Camera view_of_all(const Box& bounds, const glm::vec3& up_world, float fov_y_rad, int width_px,
                   int height_px) {
  constexpr float kFramesPerRadius = 1.15f;
  constexpr float kDown = 0.35f;
  const glm::vec3 up = glm::normalize(up_world),
                  ahead = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 forward = glm::normalize(ahead - glm::dot(ahead, up) * up - kDown * up);
  const float size = glm::length(bounds.extent()), radius = size > 0 ? 0.5f * size : 1.0f;
  return look_at(bounds.centre() - kFramesPerRadius * radius / std::sin(0.5f * fov_y_rad) * forward,
                 bounds.centre(), up, fov_y_rad, width_px, height_px);
}

std::optional<Camera> better_first_view(const GaussianCloud& cloud, const Box& bounds,
                                        const glm::vec3& up_world, const Camera& outside, const Job& job) {
  constexpr double kSharpEnough = 0.75;  // of what is covered: below, some of it is blurs
  constexpr double kClearlySharper =
      3;  // times the view given; 4 in a captured room, 1.7 around captured objects
  constexpr double kFramesAll = 1.5;  // a view from outside counts that much more
  constexpr int kDirections = 8;
  constexpr float kDown = 0.2f;       // slightly down: what stands on the floor
  constexpr float kFarShare = 0.25f;  // of the scene's size: what is seen should be no nearer
  const float size = glm::length(bounds.extent());
  if (!(size > 0)) return {};  // all in one point
  const Sharpness given = sharpness(cloud, outside, job);
  if (given.of_covered > kSharpEnough) return {};
  const glm::vec3 up = glm::normalize(up_world), centre = bounds.centre(),
                  arm = outside.centre_world() - centre;
  const float fov_y = 2 * std::atan(0.5f * static_cast<float>(outside.height_px) / outside.fy_px);
  std::optional<Camera> best;
  double best_score = kClearlySharper * given.of_picture;
  const auto offer = [&](const glm::vec3& eye, const glm::vec3& target, double share) {
    if (job.cancelled()) return;
    const Camera view = look_at(eye, target, up, fov_y, outside.width_px, outside.height_px);
    const Sharpness s = sharpness(cloud, view, job);
    const double score = share * s.of_picture * std::min(1.0f, s.median_depth / (kFarShare * size));
    if (score > best_score) best_score = score, best = view;
  };
  const auto turned = [&](int i, const glm::vec3& v) {
    return glm::angleAxis(glm::two_pi<float>() * static_cast<float>(i) / kDirections, up) * v;
  };
  for (int i = 1; i < kDirections; ++i) offer(centre + turned(i, arm), centre, kFramesAll);
  const glm::vec3 level = glm::normalize(glm::dot(arm, up) * up - arm);
  for (int i = 0; i < kDirections; ++i)
    for (const float back : {0.0f, 0.15f}) {
      const glm::vec3 along = turned(i, level) - kDown * up, eye = centre - back * size * along;
      offer(eye, eye + size * along, 1);
    }
  return best;
}

}  // namespace splatcut
