#include "segment/finish/unseen_ground.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "segment/finish/surface_map.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// What a view shows of a place on the plane; of several views the first in this order counts. kNothing:
// nothing is as high as the plane there. kOther: the place is beside the picture, or something else stands
// before it.
enum class Shown { kGround, kNothing, kObject, kOther };

Shown shown_at(const SurfaceView& view, const SurfaceMap& map, const glm::vec3& world) {
  const glm::vec3 at = view.camera.camera_from_world(world);
  if (!(at.z > 0)) return Shown::kOther;
  const glm::vec2 px = glm::floor(view.camera.pixel_from_camera(at));
  if (!(px.x >= 0 && px.y >= 0 && px.x < static_cast<float>(view.depth.width()) &&
        px.y < static_cast<float>(view.depth.height())))
    return Shown::kOther;
  const int x = static_cast<int>(px.x), y = static_cast<int>(px.y);
  if (view.inside.at(x, y)) return Shown::kObject;
  if (!(view.depth.at(x, y) > 0)) return Shown::kNothing;
  const float height = map.height_radii(view.world(x, y));
  if (height < -SurfaceMap::kOnPlane) return Shown::kNothing;  // seen through
  return height <= SurfaceMap::kOnPlane ? Shown::kGround : Shown::kOther;
}

// The same of all views that stand above the plane.
Shown shown_of(std::span<const SurfaceView> views, const SurfaceMap& map, const glm::vec3& world) {
  Shown best = Shown::kOther;
  for (const SurfaceView& view : views)
    if (map.height_radii(view.camera.centre_world()) > 0)  // else it sees the other side
      best = std::min(best, shown_at(view, map, world));
  return best;
}

constexpr int kSpeckCells = 2;  // half the width of what counts as noise of depth

}  // namespace

UnseenGround unseen_ground(const Drawer& scene, std::span<const std::uint8_t> labels,
                           const glm::vec3& up_world, std::span<const Camera> cameras, const Job& job) {
  UnseenGround ground;
  job.progress("ground that nobody saw", 0);
  const std::optional<SurfaceBelow> surface =
      surface_below(scene, labels, up_world, cameras, &ground.why_not, job);
  if (!surface) return ground;
  const SurfaceMap& map = surface->map;
  Image<Shown> shown(SurfaceMap::kSidePx, SurfaceMap::kSidePx);
  for (int y = 0; y < shown.height(); ++y)
    for (int x = 0; x < shown.width(); ++x)
      shown.at(x, y) = shown_of(surface->views, map, map.on_plane(glm::vec2(x, y) + 0.5f));
  const auto shows = [&](const glm::ivec2& c, Shown what) {
    return shown.contains(c.x, c.y) && shown.at(c.x, c.y) == what;
  };
  const Mask behind = mask_of([&](const glm::ivec2& c) { return shows(c, Shown::kObject); });
  const Mask opened = dilated(eroded(behind, kSpeckCells), kSpeckCells);
  const Mask hidden = eroded(dilated(opened, kSpeckCells), kSpeckCells);
  Mask below(SurfaceMap::kSidePx, SurfaceMap::kSidePx);
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g])
      if (const auto c = map.cell(scene.cloud().position[g]); c && is_set(hidden, *c))
        below.at(c->x, c->y) = kMaskObject;
  const Mask unseen = flooded(below, hidden),
             by_ground =
                 dilated(mask_of([&](const glm::ivec2&c) { return shows(c, Shown::kGround); }), kSpeckCells);
  const std::vector<OutlineSide> outline = outline_of(unseen, map);
  const auto at_ground =
      std::ranges::count_if(outline, [&](const OutlineSide& side) { return is_set(by_ground, side.beside); });
  for (const OutlineSide& side : outline) ground.outline_world.push_back(side.ends_world);
  ground.area = static_cast<double>(count(unseen)) * map.cell_area();
  if (2 * at_ground < std::ssize(outline)) return {.why_not = "what it stands on is not flat around it"};
  return ground;
}

}  // namespace splatcut
