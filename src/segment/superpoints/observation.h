// What observing views show of the Gaussians: how much of each, from where, and which makes each pixel.
//
// Cost: one drawing a view without colours, some 10 ms at 160 pixels and 150,000 Gaussians on one core. Same
// input, same bits, on any number of threads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// Both of the view's size.
struct ObservedPicture {
  Image<std::int32_t> gaussian;  // at which half of the pixel is covered, front to back; -1: less is
  Image<float> depth;            // expected camera z, 0 where nothing is
};

struct Observation {
  std::vector<float> seen_px;             // per Gaussian, A_g over all views
  std::vector<glm::vec3> towards_views;   // per Gaussian, sum of A_g times the direction to the view's centre
  std::vector<ObservedPicture> pictures;  // one a view
};

// Cancelled: incomplete.
Observation observe(const GaussianCloud& cloud, std::span<const Camera> views, const Job& job = {});

}  // namespace splatcut
