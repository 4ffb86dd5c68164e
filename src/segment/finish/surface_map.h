// What an object stood on, as a map: which Gaussians draw the surface, where they cover it, what stands on
// it, and where the object leaves a hole. Used by fill.cpp and unseen_ground.cpp; the numbers are explained
// in fill.h.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/raster/projected_view.h"
#include "scene/raster/rasterizer.h"
#include "segment/finish/support_plane.h"

namespace splatcut {

// The surface from far above: a drawing that is nearly a map, in which a pixel is a cell of the plane.
class SurfaceMap {
 public:
  static constexpr int kSidePx = 192;
  static constexpr float kRadii = 4;  // half of its side, in radii of the object
  static constexpr float kRadiusPx = kSidePx / (2 * kRadii);
  static constexpr float kOnPlane = 0.05f;  // radii; what lies as near to the plane is the surface

  SurfaceMap(const SupportPlane& plane, float radius);

  RasterOutput draw(const GaussianCloud& cloud, const Job& job) const {
    return rasterize(cloud, camera_, raster_, job);
  }
  std::optional<glm::ivec2> cell(const glm::vec3& world) const;  // none outside of the map
  glm::vec3 world_of(const glm::ivec2& cells) const;             // of a difference of cells
  glm::vec3 on_plane(const glm::vec2& px) const;                 // the point of the plane there
  double cell_area() const;                                      // scene units squared
  float height_radii(const glm::vec3& world) const { return plane_.height(world) / radius_; }

 private:
  SupportPlane plane_;
  float radius_;
  Camera camera_;
  RasterOptions raster_;
};

// Cells of the map.
bool is_set(const Mask& mask, const glm::ivec2& cell);  // false outside
std::vector<glm::ivec2> cells_of(const Mask& mask);
template <class Keep>
Mask mask_of(const Keep& keep) {
  Mask mask(SurfaceMap::kSidePx, SurfaceMap::kSidePx);
  for (int y = 0; y < SurfaceMap::kSidePx; ++y)
    for (int x = 0; x < SurfaceMap::kSidePx; ++x)
      if (keep(glm::ivec2(x, y))) mask.at(x, y) = kMaskObject;
  return mask;
}

// The cells of `from`, and those of `over` that hang together with them.
Mask flooded(const Mask& from, const Mask& over);

// A side of a cell of a mask where the cell beside it is none of the mask's.
struct OutlineSide {
  glm::ivec2 beside;                           // that cell
  std::pair<glm::vec3, glm::vec3> ends_world;  // on the plane
};
std::vector<OutlineSide> outline_of(const Mask& mask, const SurfaceMap& map);

// A view from which the object and the surface around it are seen.
struct SurfaceView {
  Camera camera;
  Image<float> depth;  // camera z of the surface, 0 where there is none
  Mask inside;         // of the object
  glm::vec3 world(int x, int y) const {
    return camera.world_from_pixel({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f},
                                   depth.at(x, y));
  }
};

// What a dozen views show of the surface that an object stands on, and its map.
struct SurfaceBelow {
  std::vector<SurfaceView> views;
  SurfaceMap map;
  float share = 0;  // of what surrounds the object that lies in the plane
};
// At least one Gaussian is labelled. None: nothing flat touches the object, or it was cancelled; why_not then
// says so in a sentence without a full stop.
std::optional<SurfaceBelow> surface_below(const Drawer& scene, std::span<const std::uint8_t> labels,
                                          const glm::vec3& up_world, std::span<const Camera> cameras,
                                          std::string* why_not, const Job& job);

// Masks and colours of the map.
struct Ground {
  std::vector<std::uint32_t> layer;    // Gaussians that draw the surface
  std::vector<std::uint32_t> backing;  // others just below it, which keep it from being seen through
  std::vector<std::uint32_t> rubbish;  // near the plane and below the object, never seen
  Mask object, covered, well_covered, clear;
  Image<glm::vec3> colour;  // where it is covered
};
// gone: per Gaussian, 1 = of the rest, but leaves with the object.
Ground ground_of(const SurfaceMap& map, const Drawer& scene, std::span<const std::uint8_t> labels,
                 std::span<const std::uint8_t> gone, std::span<const SurfaceView> views, const Job& job);

// What the object leaves, its contact shadow with it.
Mask hole_of(const Ground& ground);

}  // namespace splatcut
