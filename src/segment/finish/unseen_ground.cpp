#include "segment/finish/unseen_ground.h"

#include <cmath>
#include <optional>

#include "segment/finish/surface_map.h"

namespace splatcut {

namespace {

enum class Shown { kGround, kObject, kOther };  // kOther: beside the picture, or behind something else

Shown shown_at(const SurfaceView& view, const SurfaceMap& map, const glm::vec3& world) {
  const glm::vec3 at = view.camera.camera_from_world(world);
  if (!(at.z > 0)) return Shown::kOther;
  const glm::vec2 px = glm::floor(view.camera.pixel_from_camera(at));
  if (!(px.x >= 0 && px.y >= 0 && px.x < static_cast<float>(view.depth.width()) &&
        px.y < static_cast<float>(view.depth.height())))
    return Shown::kOther;
  const int x = static_cast<int>(px.x), y = static_cast<int>(px.y);
  if (view.inside.at(x, y)) return Shown::kObject;
  const bool empty = !(view.depth.at(x, y) > 0);
  const bool on_plane = !empty && std::abs(map.height_radii(view.world(x, y))) <= SurfaceMap::kOnPlane;
  return empty || on_plane ? Shown::kGround : Shown::kOther;
}

bool never_seen(std::span<const SurfaceView> views, const SurfaceMap& map, const glm::vec3& world) {
  bool behind_object = false;
  for (const SurfaceView& view : views) {
    if (map.height_radii(view.camera.centre_world()) <= 0) continue;  // it sees the other side
    const Shown shown = shown_at(view, map, world);
    if (shown == Shown::kGround) return false;
    behind_object |= shown == Shown::kObject;
  }
  return behind_object;
}

}  // namespace

UnseenGround unseen_ground(const Drawer& scene, std::span<const std::uint8_t> labels,
                           const glm::vec3& up_world, std::span<const Camera> cameras, const Job& job) {
  UnseenGround ground;
  job.progress("ground that nobody saw", 0);
  const std::optional<SurfaceBelow> surface =
      surface_below(scene, labels, up_world, cameras, &ground.why_not, job);
  if (!surface) return ground;
  const SurfaceMap& map = surface->map;
  const Mask hidden = mask_of([&](const glm::ivec2& c) {
    return never_seen(surface->views, map, map.on_plane(glm::vec2(c) + 0.5f));
  });
  Mask below(SurfaceMap::kSidePx, SurfaceMap::kSidePx);
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g])
      if (const auto c = map.cell(scene.cloud().position[g]); c && is_set(hidden, *c))
        below.at(c->x, c->y) = kMaskObject;
  const Mask unseen = flooded(below, hidden);
  for (const glm::ivec2& c : cells_of(unseen)) {
    ground.area += map.cell_area();
    const glm::ivec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                     beside[] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    for (int side = 0; side < 4; ++side)
      if (!is_set(unseen, c + beside[side]))
        ground.outline_world.emplace_back(map.on_plane(glm::vec2(c + corners[side])),
                                          map.on_plane(glm::vec2(c + corners[(side + 1) % 4])));
  }
  return ground;
}

}  // namespace splatcut
