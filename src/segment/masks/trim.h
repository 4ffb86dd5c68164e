// Takes out of a cutout what would show beside the object once the scene around it is gone: faint splats of
// lawn, shadow or haze that hide in the scene's own pictures.
//
// The object is rendered alone into the views; a Gaussian most of whose A_g then lies where the view's mask
// says rest, and where no other part of the scene hides the object, leaves the object. What no view shows
// stays. Cost: two small renderings per view, and a third where the scene's depth is not at hand, in at most
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
