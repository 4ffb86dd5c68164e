// How much of an object others hide in a view.
#pragma once

#include <cstdint>
#include <vector>

#include "app/document/opened_scene.h"
#include "core/job.h"
#include "scene/camera/camera.h"

namespace splatcut {

// The share of the object's picture, 0 to 1, that others hide who stand `apart` scene units or more before
// it. What it is set into, and the blurred splats around it, do not. labels: 1 for the object's Gaussians.
// Cancelled: 0.
double hidden_share(const OpenedScene& scene, const std::vector<std::uint8_t>& labels, const Camera& camera,
                    float apart, const Job& job);

}  // namespace splatcut
