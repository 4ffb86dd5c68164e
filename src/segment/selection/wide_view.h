// The wider picture in which a correcting click is looked at.
//
// A user zooms in to mend a detail, and then the picture crops the object, and what is wrong with it. Changes
// that it does not show would count as hidden. So the click is looked at from the same place in a picture
// that also holds what is selected so far, and that is no close-up by the photographs (usual_picture.h). The
// subject of a scene without cameras says too little here: corrections of a part of it would get worse.
#pragma once

#include <cstdint>
#include <span>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/superpoints/usual_picture.h"

namespace splatcut {

// labels: per Gaussian, 1 = selected so far. Each margin is at most as wide or high as the picture. No
// margins: the picture shows enough.
Margins margins_of_correction(const Camera& camera, const GaussianCloud& cloud,
                              std::span<const std::uint8_t> labels, const Capture& capture);

}  // namespace splatcut
