#include "app/lab/study/study_variants.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/superpoints/orbit.h"

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
  const Camera camera = limited_to_width(test.reference, kLookWidthPx);
  const Mask object = labels_seen(test, camera, test.truth_labels);
  if (hidden_share <= 0 || count(object) == 0) return cloud;
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

void step_back(EvaluationCase* test, float factor) {
  const ObjectExtent object = object_extent(*test->cloud, test->truth_labels);
  test->reference = approached(test->reference, object.centre_world, factor);
  test->reference_truth = labels_seen(*test, test->reference, test->truth_labels);
}

void fill_picture(EvaluationCase* test, double share) {
  Camera& camera = test->reference;
  const std::string name = camera.name;
  const glm::vec3 centre = object_extent(*test->cloud, test->truth_labels).centre_world;
  float focal_px = camera.fy_px;
  constexpr int kTries = 4;  // the area grows with the focal length's square, but for the picture's edge
  for (int i = 0; i < kTries; ++i) {
    const float height = static_cast<float>(camera.height_px);
    camera = look_at(camera.centre_world(), centre, -test->reference.down_world(),
                     2 * std::atan(0.5f * height / focal_px), camera.width_px, camera.height_px);
    const double now =
        share_of(labels_seen(*test, limited_to_width(camera, kLookWidthPx), test->truth_labels));
    if (i + 1 == kTries || now <= 0) break;
    focal_px = std::clamp(focal_px * static_cast<float>(std::sqrt(share / now)), 0.2f * height, 60 * height);
  }
  camera.name = name;
  test->reference_truth = labels_seen(*test, camera, test->truth_labels);
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
