#include "segment/finish/surface_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "segment/finish/own_views.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kSidePx = SurfaceMap::kSidePx;
constexpr float kNearPlane = 0.2f, kOn = SurfaceMap::kOnPlane;  // of the radius, from the plane
constexpr float kCovers = 0.7f, kCoversWell = 0.9f, kStands = 0.3f;

bool on_map(const glm::ivec2& c) {
  return c.x >= 0 && c.y >= 0 && c.x < kSidePx && c.y < kSidePx;
}

// The Gaussians, with their constant colour alone: one colour from all sides.
GaussianCloud plain(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  GaussianCloud some = permuted(cloud, gaussians);
  some.sh_degree = 0;
  some.sh_rest.clear();
  return some;
}

// Whose pixels a Gaussian draws in those views.
enum DrawnPlane : std::size_t { kDrawn, kOnSurface, kAbove, kDrawnPlanes };

PlaneSums drawn_pixels(const Drawer& scene, std::span<const SurfaceView> views, const SurfaceMap& map,
                       const Job& job) {
  PlaneSums sums(scene.cloud().size(), kDrawnPlanes);
  for (const SurfaceView& view : views) {
    const int width = view.depth.width(), height = view.depth.height();
    std::vector<Image<float>> planes(kDrawnPlanes, Image<float>(width, height));
    std::ranges::fill(planes[kDrawn].pixels(), 1.0f);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (!(view.depth.at(x, y) > 0) || view.inside.at(x, y)) continue;
        const float h = map.height_radii(view.world(x, y));
        if (std::abs(h) <= kOn) planes[kOnSurface].at(x, y) = 1;
        if (h > kOn) planes[kAbove].at(x, y) = 1;
      }
    RasterOptions raster;
    raster.colour = false;
    raster.sum_planes = planes;
    raster.plane_sums = &sums;
    scene.draw(view.camera, raster, job);
  }
  return sums;
}

bool surrounded(const Ground& ground, const glm::ivec2& cell) {
  constexpr int kDirections = 16, kLeast = 10;
  int met = 0;
  for (int d = 0; d < kDirections; ++d) {
    const float turn = glm::two_pi<float>() * static_cast<float>(d) / kDirections;
    const glm::vec2 step(std::cos(turn), std::sin(turn));
    for (float far = 1; far < kSidePx; ++far) {
      const glm::ivec2 at = cell + glm::ivec2(glm::round(far * step));
      if (!on_map(at)) break;
      if (!is_set(ground.covered, at)) continue;
      ++met;
      break;
    }
  }
  return met >= kLeast;
}

// Brightness of the surface, mean of the covered cells within two; 0 where there are none.
Image<float> brightness_of(const Ground& ground) {
  Image<float> brightness(kSidePx, kSidePx);
  for (int y = 0; y < kSidePx; ++y)
    for (int x = 0; x < kSidePx; ++x) {
      float sum = 0, count = 0;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const glm::ivec2 near(x + dx, y + dy);
          if (!is_set(ground.covered, near)) continue;
          const glm::vec3& colour = ground.colour.at(near.x, near.y);
          sum += (colour.r + colour.g + colour.b) / 3;
          ++count;
        }
      brightness.at(x, y) = count > 0 ? sum / count : 0;
    }
  return brightness;
}

// Cells that are darker than the surface farther from the object.
Mask shade_of(const Ground& ground, int near_px, int far_px) {
  constexpr float kLeastDarker = 0.06f;
  const Image<float> brightness = brightness_of(ground);
  const auto surface = [&](const glm::ivec2& c) {
    return is_set(ground.covered, c) && is_set(ground.clear, c);
  };
  const Mask near = dilated(ground.object, near_px);
  double sum = 0, squares = 0, count = 0;
  for (const glm::ivec2& c : cells_of(dilated(ground.object, far_px))) {
    if (is_set(near, c) || !surface(c)) continue;
    const double b = static_cast<double>(brightness.at(c.x, c.y));
    sum += b;
    squares += b * b;
    ++count;
  }
  if (count == 0) return Mask(kSidePx, kSidePx);
  const double mean = sum / count, spread = std::sqrt(std::max(0.0, squares / count - mean * mean));
  const float most = static_cast<float>(mean) - std::max(kLeastDarker, static_cast<float>(spread));
  return mask_of([&](auto c) { return is_set(near, c) && surface(c) && brightness.at(c.x, c.y) < most; });
}

std::vector<SurfaceView> surface_views(const Drawer& scene, std::span<const std::uint8_t> labels,
                                       const glm::vec3& up_world, std::span<const Camera> cameras,
                                       const Job& job) {
  constexpr OwnViewOptions kOptions{.object_px = 100, .distance_sizes = 4};
  constexpr float kObjectShare = 0.4f;
  std::vector<SurfaceView> views;
  for (const Camera& camera : own_cameras(scene.cloud(), labels, up_world, cameras, kOptions)) {
    RasterOptions raster;
    raster.colour = false;
    raster.depth = true;
    raster.labels = labels;
    RasterOutput drawn = scene.draw(camera, raster, job);
    if (job.cancelled()) break;
    views.push_back({camera, std::move(drawn.median_depth), thresholded(drawn.label_share, kObjectShare)});
  }
  return views;
}

std::optional<SupportPlane> plane_below(std::span<const SurfaceView> views, const ObjectExtent& object,
                                        const glm::vec3& up_world) {
  std::vector<glm::vec3> on_object, on_rest;
  constexpr int kDepthBorderPx = 2;  // whose depth is between the two
  for (const SurfaceView& view : views) {
    const Mask object_px = eroded(view.inside, kDepthBorderPx),
               near_px = dilated(view.inside, kDepthBorderPx);
    for (int y = 0; y < view.depth.height(); y += 2)
      for (int x = 0; x < view.depth.width(); x += 2) {
        if (!(view.depth.at(x, y) > 0)) continue;
        if (object_px.at(x, y)) on_object.push_back(view.world(x, y));
        if (!near_px.at(x, y)) on_rest.push_back(view.world(x, y));
      }
  }
  return support_plane(on_object, on_rest, object, up_world);
}

}  // namespace

SurfaceMap::SurfaceMap(const SupportPlane& plane, float radius) : plane_(plane), radius_(radius) {
  constexpr float kFar = 30;  // radii
  const glm::vec3& n = plane.normal_world;
  const glm::vec3 level = std::abs(n.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  camera_ = look_at(plane.point_world + kFar * radius * n, plane.point_world, level,
                    2 * std::atan(kRadii / kFar), kSidePx, kSidePx);
  raster_.near_plane = (kFar - 2 * kRadii) * radius;
}

std::optional<glm::ivec2> SurfaceMap::cell(const glm::vec3& world) const {
  const glm::vec3 at = camera_.camera_from_world(world);
  if (!(at.z > 0)) return {};
  const glm::vec2 px = glm::floor(camera_.pixel_from_camera(at));
  if (!(px.x >= 0 && px.y >= 0 && px.x < kSidePx && px.y < kSidePx)) return {};
  return glm::ivec2(px);
}

glm::vec3 SurfaceMap::world_of(const glm::ivec2& cells) const {
  return glm::transpose(camera_.camera_from_world_rotation) * (glm::vec3(cells, 0) * (radius_ / kRadiusPx));
}

glm::vec3 SurfaceMap::on_plane(const glm::vec2& px) const {
  return camera_.world_from_pixel(px, camera_.camera_from_world(plane_.point_world).z);
}

double SurfaceMap::cell_area() const {
  return std::pow(radius_ / kRadiusPx, 2);
}

bool is_set(const Mask& mask, const glm::ivec2& cell) {
  return on_map(cell) && mask.at(cell.x, cell.y) != 0;
}

std::vector<glm::ivec2> cells_of(const Mask& mask) {
  std::vector<glm::ivec2> cells;
  for (int y = 0; y < kSidePx; ++y)
    for (int x = 0; x < kSidePx; ++x)
      if (mask.at(x, y)) cells.emplace_back(x, y);
  return cells;
}

Mask flooded(const Mask& from, const Mask& over) {
  Mask flood = from;
  std::vector<glm::ivec2> front = cells_of(from);
  while (!front.empty()) {
    const glm::ivec2 c = front.back();
    front.pop_back();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const glm::ivec2 beside = c + glm::ivec2(dx, dy);
        if (!is_set(over, beside) || is_set(flood, beside)) continue;
        flood.at(beside.x, beside.y) = kMaskObject;
        front.push_back(beside);
      }
  }
  return flood;
}

std::vector<OutlineSide> outline_of(const Mask& mask, const SurfaceMap& map) {
  constexpr std::array<glm::ivec2, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
                                      kBeside = {{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  std::vector<OutlineSide> sides;
  for (const glm::ivec2& c : cells_of(mask))
    for (std::size_t side = 0; side < 4; ++side)
      if (!is_set(mask, c + kBeside[side]))
        sides.push_back({c + kBeside[side],
                         {map.on_plane(glm::vec2(c + kCorners[side])),
                          map.on_plane(glm::vec2(c + kCorners[(side + 1) % 4]))}});
  return sides;
}

std::optional<SurfaceBelow> surface_below(const Drawer& scene, std::span<const std::uint8_t> labels,
                                          const glm::vec3& up_world, std::span<const Camera> cameras,
                                          std::string* why_not, const Job& job) {
  const ObjectExtent object = object_extent(scene.cloud(), labels);
  std::vector<SurfaceView> views = surface_views(scene, labels, up_world, cameras, job);
  const std::optional<SupportPlane> plane = plane_below(views, object, glm::normalize(up_world));
  if (plane) return SurfaceBelow{std::move(views), {*plane, object.radius}, plane->share};
  *why_not = "no flat surface was found that the object touches";
  return {};
}

Ground ground_of(const SurfaceMap& map, const Drawer& scene, std::span<const std::uint8_t> labels,
                 std::span<const std::uint8_t> gone, std::span<const SurfaceView> views, const Job& job) {
  const GaussianCloud& cloud = scene.cloud();
  const PlaneSums drawn = drawn_pixels(scene, views, map, job);
  constexpr double kSeenPx = 0.5;
  Ground ground;
  std::vector<std::uint32_t> object, standing, unseen;
  for (std::uint32_t g = 0; g < cloud.size(); ++g) {
    if (gone[g] || !map.cell(cloud.position[g])) continue;
    const double all = drawn.at(g, kDrawn);
    const float height = map.height_radii(cloud.position[g]);
    const bool near = std::abs(height) <= kNearPlane;
    if (labels[g])
      object.push_back(g);
    else if (all >= kSeenPx && 2 * drawn.at(g, kAbove) > all)
      standing.push_back(g);
    else if (near && all >= kSeenPx && 2 * drawn.at(g, kOnSurface) > all)
      ground.layer.push_back(g);
    else if (near && all < kSeenPx)
      unseen.push_back(g);
    else if (near && height <= kOn)
      ground.backing.push_back(g);
  }
  const Image<float> above = map.draw(plain(cloud, object), job).alpha;
  if (job.cancelled()) return ground;
  ground.object = dilated(mask_of([&](auto c) { return above.at(c.x, c.y) > kStands; }), 2);
  for (const std::uint32_t g : unseen) {
    if (is_set(ground.object, *map.cell(cloud.position[g])))
      ground.rubbish.push_back(g);
    else if (map.height_radii(cloud.position[g]) <= kOn)
      ground.backing.push_back(g);
  }
  const RasterOutput surface = map.draw(plain(cloud, ground.layer), job);
  const Image<float> others = map.draw(plain(cloud, standing), job).alpha;
  if (job.cancelled()) return ground;
  ground.covered = mask_of([&](auto c) { return surface.alpha.at(c.x, c.y) >= kCovers; });
  ground.well_covered = mask_of([&](auto c) { return surface.alpha.at(c.x, c.y) >= kCoversWell; });
  ground.clear = mask_of([&](auto c) { return others.at(c.x, c.y) < kStands; });
  ground.colour = surface.colour;
  for (std::size_t i = 0; i < ground.colour.size(); ++i)
    ground.colour.pixels()[i] /= std::max(surface.alpha.pixels()[i], kStands);
  return ground;
}

Mask hole_of(const Ground& ground) {
  constexpr int kNearPx = static_cast<int>(0.6f * SurfaceMap::kRadiusPx),
                kFarPx = static_cast<int>(1.2f * SurfaceMap::kRadiusPx);
  const Mask shade = shade_of(ground, kNearPx, kFarPx);
  const Mask below = mask_of([&](auto c) {
    return is_set(ground.object, c) &&
           (is_set(shade, c) || (!is_set(ground.covered, c) && surrounded(ground, c)));
  });
  constexpr int kPenumbraPx = 3;
  constexpr double kReach = 0.6;  // of the side of what lies below: a lamp's post has no wide shade
  const Mask reach = dilated(below, static_cast<int>(kReach * std::sqrt(static_cast<double>(count(below)))));
  const Mask dark = flooded(below, mask_of([&](auto c) { return is_set(shade, c) && is_set(reach, c); }));
  const Mask wide = dilated(dark, kPenumbraPx);
  return mask_of([&](auto c) {
    return is_set(dark, c) || (is_set(wide, c) && is_set(ground.covered, c) && is_set(ground.clear, c));
  });
}

}  // namespace splatcut
