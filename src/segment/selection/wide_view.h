// The wider picture in which a correcting click is looked at.
//
// A user zooms in to mend a detail, and then the picture crops the object, and what is wrong with it. Changes
// that it does not show would count as hidden. So the click is looked at from the same place in a picture
// that also holds what is selected so far, and that is no close-up (photographed.h).
#pragma once

#include <cstdint>
#include <span>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// labels: per Gaussian, 1 = selected so far. photographs: cameras of the capture, where known. Each margin is
// at most as wide or high as the picture. No margins: the picture shows enough.
Margins margins_of_correction(const Camera& camera, const GaussianCloud& cloud,
                              std::span<const std::uint8_t> labels, std::span<const Camera> photographs);

}  // namespace splatcut
