// An object seen in its own views: where its labels show it within the scene, and where something nearer
// hides it. No photograph, nothing said by the user: the labels' own picture is the mask.
//
// In: the scene, labels, cameras. Out per camera, in the rectangle around the object:
//   inside = L > .4, or alpha > .5 and L > .15      L: sum of alpha T of the labelled within the scene,
//   valid  = inside, or alpha < .05,                alpha, depth: of the object alone
//            or depth <= 1.02 of the scene's and L < .93 alpha
// The second half of `inside` keeps bars thinner than a pixel. Where the scene shows as much of the object as
// there is, nothing was hidden: fur and other soft edges are the object's own. Cost: two drawings of the
// scene and one of the object a view.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/projected_view.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

// Squared error of the object drawn alone on black, to the scene's picture inside and to black outside.
struct PictureError {
  double squares = 0, inside_px = 0;

  double mean() const { return inside_px > 0 ? squares / inside_px : 0; }  // per channel and pixel inside
};

struct OwnView {
  Camera camera;
  PixelRect rect;            // of the camera's picture; images below have its size
  Mask inside, valid;        // 0 or kMaskObject
  Image<glm::vec3> colour;   // of the scene
  Image<float> depth;        // of the scene
  double agreement = 0;      // IoU of the object alone and of the labels within the scene, at valid pixels
  std::size_t shown_px = 0;  // that show the object within the scene
  PictureError error;        // of the object as it is
};

// The rectangle is empty where no labelled Gaussian is in view. object: the labelled Gaussians alone.
OwnView own_view(const Drawer& scene, const GaussianCloud& object, std::span<const std::uint8_t> labels,
                 const Camera& camera, const Job& job);

// The error summed over all views. kept: per Gaussian of the object, 0 = not drawn.
PictureError own_picture_error(std::span<const OwnView> views, const GaussianCloud& object,
                               std::span<const std::uint8_t> kept, const Job& job);

struct OwnViewOptions {
  int views = 12;
  int picture_px = 320;  // width, at least, of capture cameras no more than their own; of others height, too
  int object_px = 300;   // the object's size in the picture, at least, where a capture camera has that many
  float distance_sizes = OrbitOptions{}.distance_sizes;  // of the others: over the object's size
};

// Cameras around the labelled Gaussians, the same for the same labels wherever the user stands: about those
// of the capture, else on two circles, 10 and 35 degrees above the object.
std::vector<Camera> own_cameras(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
                                const glm::vec3& up_world, std::span<const Camera> given,
                                const OwnViewOptions& options);

}  // namespace splatcut
