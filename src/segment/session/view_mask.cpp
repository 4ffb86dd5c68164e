#include "segment/session/view_mask.h"

#include <utility>

#include "core/png_file.h"
#include "core/stage_clock.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

// A view is left out where the scene leaves less than this share visible of what the object would show alone.
constexpr double kHidden = 0.2;

// Distances to look from in turn, where a wall or another thing stands before the object.
constexpr float kApproaches[] = {1.0f, 0.7f, 0.5f};

bool hidden(const CutTask& task, const Camera& camera, const std::vector<std::uint8_t>& labels,
            const Mask& seen) {
  const PixelRect rect = labelled_rectangle(task.scene.drawer.cloud(), camera, labels);
  if (rect.empty()) return true;
  const auto shown = static_cast<double>(count(seen));
  if (shown / (rect.width() * rect.height()) >= kHidden)
    return false;  // alone it has no more pixels than these: no need to draw
  RasterOptions options;
  options.colour = false;
  options.shown = labels;
  options.roi = rect;
  const std::size_t alone = count(thresholded(task.scene.drawer.draw(camera, options, task.job).alpha, 0.5f));
  return alone == 0 || shown / static_cast<double>(alone) < kHidden;
}

}  // namespace

ViewPicture view_picture(const Drawer& drawer, const Camera& camera, const Job& job) {
  RasterOptions options;
  options.depth = true;
  RasterOutput out = drawer.draw(camera, options, job);
  return {rgb8_from_linear(out.colour), std::move(out.expected_depth), std::move(out.median_depth)};
}

Mask labels_in_view(const Drawer& drawer, const Camera& camera, const std::vector<std::uint8_t>& labels,
                    const Job& job) {
  return thresholded(render_labels(drawer, camera, labels, job), 0.5f);
}

std::optional<FoundView> find_in_view(const CutTask& task, const Camera& camera,
                                      const glm::vec3& object_centre_world, std::span<const SeenView> seen,
                                      CutResult* result) {
  StageClock clock(&result->stages);
  const CutSettings& settings = task.settings;
  const Drawer& drawer = task.scene.drawer;
  const bool needs_picture = settings.propagate.of_pictures || settings.refine.solver != MaskSolver::kNone;
  FoundView found;
  for (const float share : kApproaches) {
    const Camera nearer = approached(camera, object_centre_world, share);
    found.picture = {};
    if (needs_picture)
      found.picture = clock.time("view", [&] { return view_picture(drawer, nearer, task.job); });
    const OpenView open{nearer, found.picture.rgb, found.picture.depth, seen,
                        [&] { return labels_in_view(drawer, nearer, result->labels, task.job); }};
    const Mask mask = clock.time(settings.propagate.stage, [&] { return settings.propagate.mask(open); });
    if (task.job.cancelled()) return std::nullopt;
    if (settings.hidden_test &&
        clock.time("labels in views", [&] { return hidden(task, nearer, result->labels, mask); }))
      continue;
    Mask settled = clock.time(
        "masks", [&] { return refine_mask(found.picture.rgb, found.picture.depth, mask, settings.refine); });
    found.report = {.camera = nearer, .mask = std::move(settled), .used = true, .reason = {}};
    return found;
  }
  found.picture = {};
  found.report = {.camera = camera,
                  .mask = Mask(camera.width_px, camera.height_px),
                  .reason = "the object is hidden here"};
  return found;
}

}  // namespace splatcut
