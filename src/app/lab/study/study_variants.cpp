#include "app/lab/study/study_variants.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kLookWidthPx = 320;

Camera rescaled(Camera camera, float scale) {
  camera.camera_from_world_translation *= scale;
  return camera;
}

double share_of(const Mask& mask) {
  return static_cast<double>(count(mask)) / static_cast<double>(mask.size());
}

// The pixels that the board covers: the mask's rectangle up to the column left of which the share lies.
PixelRect board_rectangle(const Mask& object, double share) {
  constexpr int kMarginPx = 12;
  const PixelRect box = bounds(object);
  const double wanted = share * static_cast<double>(count(object));
  std::size_t covered = 0;
  int column = box.x0;
  for (; column < box.x1 && static_cast<double>(covered) < wanted; ++column)
    for (int y = box.y0; y < box.y1; ++y) covered += object.at(column, y) != 0;
  return {box.x0 - kMarginPx, box.y0 - kMarginPx, column, box.y1 + kMarginPx};
}

float nearest_depth(const Image<float>& depth, const Mask& object) {
  float nearest = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < object.size(); ++i)
    if (object.pixels()[i] && depth.pixels()[i] > 0) nearest = std::min(nearest, depth.pixels()[i]);
  return nearest;
}

// In a small picture of the view.
float depth_at(const GaussianCloud& cloud, const Camera& camera, const glm::vec2& pixel) {
  const Camera small = limited_to_width(camera, kLookWidthPx);
  const float scale = static_cast<float>(small.width_px) / static_cast<float>(camera.width_px);
  RasterOptions options;
  options.depth = true;
  return rasterize(cloud, small, options)
      .median_depth.at(std::min(small.width_px - 1, static_cast<int>(scale * pixel.x)),
                       std::min(small.height_px - 1, static_cast<int>(scale * pixel.y)));
}

void add_disc(const glm::vec3& at, float radius, const glm::quat& facing, GaussianCloud* cloud) {
  constexpr float kOpacity = 0.99f;
  const std::uint32_t row = static_cast<std::uint32_t>(cloud->size());
  cloud->position.push_back(at);
  cloud->scale.emplace_back(radius, radius, 0.05f * radius);
  cloud->rotation.push_back(facing);
  cloud->opacity.push_back(kOpacity);
  cloud->f_dc.emplace_back(-0.4f, -0.2f, 0.3f);  // a dull blue
  cloud->sh_rest.resize(cloud->sh_rest.size() + cloud->sh_stride(), 0.0f);
  cloud->file_row.push_back(row);
}

}  // namespace

GaussianCloud rescaled(const GaussianCloud& cloud, float scale) {
  GaussianCloud out = cloud;
  for (glm::vec3& p : out.position) p *= scale;
  for (glm::vec3& s : out.scale) s *= scale;
  out.near_plane = natural_near_plane(out.position);
  return out;
}

EvaluationCase rescaled(EvaluationCase test, float scale) {
  for (Camera& camera : test.test_views) camera = rescaled(camera, scale);
  for (Camera& camera : test.scene_cameras) camera = rescaled(camera, scale);
  test.reference = rescaled(test.reference, scale);
  return test;
}

GaussianCloud with_board(const EvaluationCase& test, double hidden_share) {
  GaussianCloud cloud = *test.cloud;
  if (hidden_share <= 0) return cloud;
  const Camera camera = limited_to_width(test.reference, kLookWidthPx);
  const Mask object = labels_seen(test, camera, test.truth_labels);
  if (count(object) == 0) return cloud;
  constexpr float kNearness = 0.6f, kStepPx = 4,
                  kOverlap = 0.75f;  // standard deviation over the discs' distance
  RasterOptions options;
  options.depth = true;
  const float z = kNearness * nearest_depth(rasterize(*test.cloud, camera, options).median_depth, object);
  const PixelRect rect = board_rectangle(object, hidden_share);
  const glm::quat facing = glm::quat_cast(glm::transpose(camera.camera_from_world_rotation));
  const float step = kStepPx * z / camera.fx_px,
              edge_px = kOverlap * kStepPx;  // discs reach about that far beyond their centres
  for (float y = static_cast<float>(rect.y0); y <= static_cast<float>(rect.y1); y += kStepPx)
    for (float x = static_cast<float>(rect.x1) - edge_px; x >= static_cast<float>(rect.x0); x -= kStepPx)
      add_disc(camera.world_from_pixel({x, y}, z), kOverlap * step, facing, &cloud);
  return cloud;
}

std::optional<glm::vec3> clicked_point(const GaussianCloud& cloud, const ViewClick& click) {
  const glm::vec2 pixel = click.stroke.points_px.front();
  const float z = depth_at(cloud, click.camera, pixel);
  return z > 0 ? std::optional(click.camera.world_from_pixel(pixel, z)) : std::nullopt;
}

std::optional<ViewClick> clicked_from(const Camera& other, const GaussianCloud& cloud,
                                      const ViewClick& click) {
  constexpr float kSameThing = 0.2f;  // of the depth
  const auto point = clicked_point(cloud, click);
  if (!point) return std::nullopt;
  const glm::vec3 there = other.camera_from_world(*point);
  if (!(there.z > 0)) return std::nullopt;
  const glm::vec2 pixel = other.pixel_from_camera(there);
  const bool inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(other.width_px) &&
                      pixel.y < static_cast<float>(other.height_px);
  if (!inside || std::abs(depth_at(cloud, other, pixel) / there.z - 1) > kSameThing) return std::nullopt;
  return ViewClick{other, splatcut::click(pixel, click.stroke.label)};
}

Camera framed(const Camera& camera, const glm::vec3& point_world, const Mask& object, double share) {
  const float height = static_cast<float>(camera.height_px);
  const float focal_px =
      std::clamp(camera.fy_px * static_cast<float>(std::sqrt(share / std::max(1e-6, share_of(object)))),
                 0.2f * height, 60 * height);
  Camera turned = look_at(camera.centre_world(), point_world, -camera.down_world(),
                          2 * std::atan(0.5f * height / focal_px), camera.width_px, camera.height_px);
  turned.name = camera.name;
  return turned;
}

void resize_tests(EvaluationCase* test, double factor) {
  for (std::size_t v = 0; v < test->test_views.size(); ++v) {
    Camera& view = test->test_views[v];
    const auto pixels = [factor](int n) { return std::max(1, static_cast<int>(std::lround(factor * n))); };
    view = resized(view, pixels(view.width_px), pixels(view.height_px));
    test->truth_masks[v] = test->truth_labels.empty()
                               ? resized_mask(test->truth_masks[v], view.width_px, view.height_px)
                               : labels_seen(*test, view, test->truth_labels);
  }
}

glm::vec3 tilted(const glm::vec3& up, const Camera& reference, double degrees) {
  return glm::angleAxis(glm::radians(static_cast<float>(degrees)), reference.forward_world()) * up;
}

}  // namespace splatcut
