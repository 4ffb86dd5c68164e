// Cameras of the small views that show which side of a surface is outside, and which Gaussians are visible.
//
// The cameras of the photographs are the best choice; without them, the reference view and a ring of views
// around what it looks at. (Views spread over the scene's free space were worse: .64 against .66-.80 mean
// first-click IoU on 43 objects.)
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct ObservingOptions {
  int width_px = 160;
  int most_given = 24;  // of given cameras, evenly chosen
  int ring = 11;        // without given cameras
  float elevation_swing_rad = 0.35f;
};

// given: cameras of the scene's photographs, may be empty. The reference is always among the views.
std::vector<Camera> observing_views(const GaussianCloud& cloud, const Camera& reference,
                                    const glm::vec3& up_world, std::span<const Camera> given,
                                    const ObservingOptions& options = {}, const Job& job = {});

}  // namespace splatcut
