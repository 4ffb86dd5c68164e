#include "segment/session/reference_mask.h"

#include <algorithm>
#include <utility>

#include "core/stage_clock.h"
#include "scene/raster/rasterizer.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/view_mask.h"
#include "segment/superpoints/part_view.h"

namespace splatcut {

namespace {

PartView parts_in(const CutTask& task, const Camera& camera, Image<float>* median_depth) {
  RasterOptions raster;
  raster.colour = false;
  raster.depth = true;
  RasterOutput out = task.scene.drawer.draw(camera, raster, task.job);
  *median_depth = std::move(out.median_depth);
  return view_parts(task.scene.parts, out.first_hit);
}

void join_enclosed_by(const CutTask& task, const PartView& view, std::vector<std::uint8_t>* labels) {
  if (!task.settings.join_enclosed || view.trees.empty()) return;
  const PartHierarchy& parts = task.scene.parts;
  const GaussianCloud& cloud = task.scene.drawer.cloud();
  std::vector<std::uint8_t> shown(cloud.size(), 0);
  for (std::size_t g = 0; g < shown.size(); ++g)
    shown[g] = parts.leaf_of[g] != kNoPart && view.trees.front().pixels[parts.leaf_of[g]] > 0;
  join_enclosed(cloud, task.scene.graph, shown, task.settings.enclosed, labels);
}

// The parts that all strokes mean become the labels.
void select_by_strokes(const CutTask& task, const Camera& camera, Image<float>* median_depth,
                       CutResult* result) {
  const ClickSelection& picked =
      task.scene.strokes.replay(task.scene.drawer, strokes_in_order(task.request),
                                replay_options(task.request, task.settings, task.scene.model), task.job);
  if (task.job.cancelled()) return;
  result->labels = picked.labels();
  result->sizes = picked.sizes();
  result->size = picked.size();
  result->likeliest_size = picked.likeliest_size();
  result->size_masks.assign(picked.size_masks().begin(), picked.size_masks().end());
  result->meanings.assign(picked.meanings().begin(), picked.meanings().end());
  result->choice = picked.choice();
  result->spot_alone = picked.spot_alone();
  result->certainty = picked.certainty();
  result->said = picked.said();
  join_enclosed_by(task, parts_in(task, camera, median_depth), &result->labels);
  obey_strokes(result);
}

// The parts that the mask means become the labels.
void select_by_mask(const CutTask& task, const Camera& camera, const Mask& mask, Image<float>* median_depth,
                    CutResult* result) {
  const PartView view = parts_in(task, camera, median_depth);
  if (task.job.cancelled()) return;
  const PartHierarchy& parts = task.scene.parts;
  result->labels = labels_of(parts, parts_of_mask(parts, view, mask, task.scene.model.of_mask));
  join_enclosed_by(task, view, &result->labels);
}

// True if a point lies behind what the view shows there and in the pixels beside it.
bool lies_behind(const Image<float>& median_depth, const Camera& camera, const glm::vec3& point_world) {
  if (!camera.shows(point_world)) return false;
  const glm::vec3 point_camera = camera.camera_from_world(point_world);
  const glm::ivec2 at = glm::floor(camera.pixel_from_camera(point_camera));
  float farthest = 0;
  for (int y = at.y - 1; y <= at.y + 1; ++y)
    for (int x = at.x - 1; x <= at.x + 1; ++x)
      if (median_depth.contains(x, y)) farthest = std::max(farthest, median_depth.at(x, y));
  return farthest > 0 && point_camera.z > farthest;
}

// Where one mask alone says what is meant, its own view shows it afterwards: a Gaussian that makes a pixel or
// more of the view, nearly all on one side of the mask, takes that side, whatever the parts and predicted
// views say. Open are those that straddle its border, and those that shine through the object from behind.
std::vector<std::int8_t> said_by_mask(const CutTask& task, const Camera& camera, const Mask& mask,
                                      const Image<float>& median_depth) {
  constexpr std::int64_t kLeast = static_cast<std::int64_t>(MaskedSums::kUnitsPerPixel);
  constexpr double kNearlyAll = 0.97;
  MaskedSums sums(task.scene.drawer.cloud().size());
  add_masked_sums(task.scene.drawer, camera, mask, false, task.job, &sums);
  std::vector<std::int8_t> said(sums.total.size(), 0);
  for (std::size_t g = 0; g < said.size(); ++g) {
    if (sums.total[g] < kLeast) continue;
    const double inside = static_cast<double>(sums.inside[g]) / static_cast<double>(sums.total[g]);
    if (inside <= 1 - kNearlyAll)
      said[g] = -1;
    else if (inside >= kNearlyAll &&
             !lies_behind(median_depth, camera, task.scene.drawer.cloud().position[g]))
      said[g] = 1;
  }
  return said;
}

ReferenceMask mask_from_pixels(const CutTask& task, const Camera& camera, StageClock* clock) {
  const float scale =
      static_cast<float>(camera.width_px) / static_cast<float>(task.reference.camera.width_px);
  const Strokes strokes = scaled(task.reference.strokes, scale);
  ViewPicture picture =
      clock->time("view", [&] { return view_picture(task.scene.drawer, camera, task.job); });
  Mask mask = clock->time("first mask", [&] {
    return first_mask(picture.rgb, picture.depth, strokes, task.settings.first_mask, task.job);
  });
  return {std::move(mask), std::move(picture.median_depth)};
}

}  // namespace

std::optional<ReferenceMask> reference_mask(const CutTask& task, const Camera& camera, CutResult* result) {
  StageClock clock(&result->stages);
  const bool by_parts = task.settings.first_mask_from == FirstMaskFrom::kParts;
  ReferenceMask found;
  if (task.request.first_mask) {
    found.mask = resized_mask(task.request.first_mask->mask, camera.width_px, camera.height_px);
    if (by_parts && count(found.mask) > 0) {
      clock.time("first mask",
                 [&] { select_by_mask(task, camera, found.mask, &found.median_depth, result); });
      result->prior = result->labels;
      if (task.request.masks.empty())
        result->said = said_by_mask(task, camera, found.mask, found.median_depth);
    }
  } else if (by_parts) {
    clock.time("first mask", [&] { select_by_strokes(task, camera, &found.median_depth, result); });
    if (task.job.cancelled()) return std::nullopt;
    result->prior = result->labels;
    found.mask = clock.time("labels in views", [&] {
      return labels_in_view(task.scene.drawer, camera, result->labels, task.job);
    });
  } else {
    found = mask_from_pixels(task, camera, &clock);
  }
  if (task.job.cancelled()) return std::nullopt;
  return found;
}

ReplayOptions replay_options(const CutRequest& request, const CutSettings& settings, const PartModel& model) {
  ReplayOptions options{.model = model.selection};
  options.choice = request.choice;
  options.work_width_px = settings.work_width_px;
  options.least_object_px = settings.least_object_px;
  options.carried = request.carried;
  return options;
}

std::vector<CameraStroke> strokes_in_order(const CutRequest& request) {
  std::vector<CameraStroke> strokes;
  for (const StrokedView& view : request.strokes)
    for (const Stroke& stroke : view.strokes) strokes.push_back({view.camera, stroke, view.seen});
  return strokes;
}

}  // namespace splatcut
