#include "segment/finish/own_views.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr float kLabelled = 0.4f, kThin = 0.15f, kSolid = 0.5f, kEmpty = 0.05f, kNearer = 1.02f, kOwn = 0.93f;
constexpr std::size_t kEnoughOfCapture = 8;

// Any direction that is not along `up`, the same for the same `up`.
glm::vec3 level_direction(const glm::vec3& up) {
  const glm::vec3 axis = std::abs(up.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  return glm::normalize(axis - glm::dot(axis, up) * up);
}

// The share of the positions that lie in the camera's picture.
float share_in_picture(std::span<const glm::vec3> positions, const Camera& camera, float near_plane) {
  std::size_t in = 0;
  for (const glm::vec3& position : positions) {
    const glm::vec3 at = camera.camera_from_world(position);
    if (!(at.z > near_plane)) continue;
    const glm::vec2 px = camera.pixel_from_camera(at);
    in += px.x >= 0 && px.y >= 0 && px.x < static_cast<float>(camera.width_px) &&
          px.y < static_cast<float>(camera.height_px);
  }
  return static_cast<float>(in) / static_cast<float>(positions.size());
}

// Those of the capture that see most of the object, as many as wanted and as far apart as seen from the
// object, the one that sees most of it first.
std::vector<Camera> capture_cameras(std::span<const glm::vec3> positions, const ObjectExtent& object,
                                    std::span<const Camera> given, float near_plane, std::size_t wanted) {
  constexpr float kLeastShare = 0.7f;
  struct CaptureView {
    const Camera* camera;
    float share;
    glm::vec3 direction;  // from the object, unit
    float nearest;        // cosine to the nearest that is chosen
  };
  std::vector<CaptureView> candidates;
  for (const Camera& camera : given) {
    const float share = share_in_picture(positions, camera, near_plane);
    const glm::vec3 away = camera.centre_world() - object.centre_world;
    if (share >= kLeastShare && glm::length(away) > object.radius)
      candidates.push_back({&camera, share, glm::normalize(away), -1});
  }
  std::vector<Camera> chosen;
  while (chosen.size() < wanted && chosen.size() < candidates.size()) {
    const auto next = chosen.empty() ? std::ranges::max_element(candidates, {}, &CaptureView::share)
                                     : std::ranges::min_element(candidates, {}, &CaptureView::nearest);
    chosen.push_back(*next->camera);
    const glm::vec3 direction = next->direction;
    for (CaptureView& c : candidates) c.nearest = std::max(c.nearest, glm::dot(c.direction, direction));
    next->nearest = 2;
  }
  return chosen;
}

// The camera with a picture as wide as the options say, or wider where the object would be small in it, up to
// the camera's own size.
Camera fine_enough(const Camera& camera, const ObjectExtent& object, const OwnViewOptions& options) {
  const float away = glm::length(camera.centre_world() - object.centre_world);
  const float own_px = 2 * object.radius * camera.fx_px / away;  // in the camera's own picture
  const float wanted_px =
      static_cast<float>(camera.width_px) * static_cast<float>(options.object_px) / own_px;
  return limited_to_width(
      camera, std::max(options.picture_px,
                       static_cast<int>(std::min(wanted_px, static_cast<float>(camera.width_px)))));
}

void add_error(const OwnView& view, const Image<glm::vec3>& alone, PictureError* error) {
  for (std::size_t i = 0; i < alone.size(); ++i) {
    if (!view.valid.pixels()[i]) continue;
    const bool inside = view.inside.pixels()[i] != 0;
    const glm::vec3 d = alone.pixels()[i] - (inside ? view.colour.pixels()[i] : glm::vec3(0));
    error->squares += static_cast<double>(glm::dot(d, d)) / 3;
    error->inside_px += inside;
  }
}

}  // namespace

OwnView own_view(const Drawer& scene, const GaussianCloud& object, std::span<const std::uint8_t> labels,
                 const Camera& camera, const Job& job) {
  OwnView view;
  view.camera = camera;
  view.rect = labelled_rectangle(scene.cloud(), camera, labels);
  if (view.rect.empty()) return view;
  RasterOptions raster;
  raster.roi = view.rect;
  view.colour = scene.draw(camera, raster, job).colour;
  raster.depth = true;
  const RasterOutput alone = rasterize(object, camera, raster, job);
  raster.colour = false;
  raster.labels = labels;
  RasterOutput within = scene.draw(camera, raster, job);
  view.inside = view.valid = Mask(view.rect.width(), view.rect.height());
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < view.inside.size(); ++i) {
    const float seen = within.label_share.pixels()[i], alpha = alone.alpha.pixels()[i];
    const bool inside = seen > kLabelled || (alpha > kSolid && seen > kThin);
    const bool hidden =
        alpha > kEmpty && alone.expected_depth.pixels()[i] > kNearer * within.expected_depth.pixels()[i];
    if (inside) view.inside.pixels()[i] = kMaskObject;
    view.shown_px += seen > kLabelled;
    const bool own = alpha > kEmpty && seen > kOwn * alpha;
    if (!inside && (hidden || own)) continue;
    view.valid.pixels()[i] = kMaskObject;
    both += alpha > kSolid && seen > kLabelled;
    either += alpha > kSolid || seen > kLabelled;
  }
  view.depth = std::move(within.expected_depth);
  add_error(view, alone.colour, &view.error);
  view.agreement = either ? static_cast<double>(both) / static_cast<double>(either) : 0;
  return view;
}

PictureError own_picture_error(std::span<const OwnView> views, const GaussianCloud& object,
                               std::span<const std::uint8_t> kept, const Job& job) {
  PictureError error;
  for (const OwnView& view : views) {
    RasterOptions raster;
    raster.roi = view.rect;
    raster.shown = kept;
    add_error(view, rasterize(object, view.camera, raster, job).colour, &error);
  }
  return error;
}

std::vector<Camera> own_cameras(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
                                const glm::vec3& up_world, std::span<const Camera> given,
                                const OwnViewOptions& options) {
  const ObjectExtent object = object_extent(cloud, labels);
  std::vector<glm::vec3> positions;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (labels[g]) positions.push_back(cloud.position[g]);
  std::vector<Camera> cameras =
      capture_cameras(positions, object, given, cloud.near_plane, static_cast<std::size_t>(options.views));
  if (cameras.size() >= kEnoughOfCapture) {
    for (Camera& camera : cameras) camera = fine_enough(camera, object, options);
    return cameras;
  }
  const glm::vec3 up = glm::normalize(up_world);
  constexpr float kFovYDeg = 40, kMiddleDeg = 22.5f, kSwingDeg = 12.5f;
  const glm::vec3 back =
      std::cos(glm::radians(kMiddleDeg)) * level_direction(up) + std::sin(glm::radians(kMiddleDeg)) * up;
  const Camera reference = look_at(object.centre_world + object.radius * back, object.centre_world, up,
                                   glm::radians(kFovYDeg), options.picture_px, options.picture_px);
  OrbitOptions orbit;
  orbit.views = options.views;
  orbit.distance_sizes = options.distance_sizes;
  orbit.elevation_swing_rad = glm::radians(kSwingDeg);
  cameras = orbit_cameras(reference, up, object, orbit);
  for (Camera& camera : cameras) camera = with_room(camera, object);
  return cameras;
}

}  // namespace splatcut
