// Removes from a cutout what would show beside the object once the scene around it is gone: floaters, and
// faint splats of lawn or shadow that the scene's own pictures hide.
//
// The object is rendered alone into the views; a Gaussian leaves the object if most of its A_g then lies
// outside of the view's mask, at pixels where nothing occludes the object. What no view shows stays. Cost:
// two small renderings per view, and a third where the scene's depth is not at hand, in at most
// options.most_views.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

struct TrimView {
  Camera camera;
  const Mask* mask = nullptr;  // of the camera's size, where the object is seen in the whole scene
  const Image<float>* scene_depth =
      nullptr;  // RasterOutput::median_depth of the whole scene, of that size; null: drawn here
};

struct TrimOptions {
  float least_inside = 0.5f;  // share of A_g inside of the masks that keeps a Gaussian
  int margin_px = 1;          // masks are right up to about that
  int most_views = 6;         // evenly chosen; more cost time and change little
  bool operator==(const TrimOptions&) const = default;
};

// labels: per Gaussian, 1 = object. Returns how many Gaussians left the object.
std::size_t trim(const Drawer& drawer, std::span<const TrimView> views, const TrimOptions& options,
                 std::vector<std::uint8_t>* labels, const Job& job = {});

}  // namespace splatcut
