// A mask carried from one view into another, in two dimensions: the ways the labels of the 3D cut, rendered
// into the next view (kLift, see pipeline.h), are measured against.
//
// Source: Kroeger et al., Fast optical flow using dense inverse search, 2016 (OpenCV's DISOpticalFlow); the
// depth warp with its z-test is ours. Same result on any number of threads.
#pragma once

#include "core/image.h"
#include "scene/camera/camera.h"

namespace splatcut {

enum class Propagator {
  kLift,  // labels of the 3D cut so far, rendered into the view
  kWarp,  // the nearest view's mask through the depth of both
  kFlow,  // the nearest view's mask along the optical flow of the two pictures
};

// A view whose mask is known. All images of one size.
struct SeenView {
  Camera camera;
  Image<Rgb8> picture;
  Image<float> depth;  // camera z, 0 where nothing is
  Mask mask;
};

// Each pixel of `to` is looked up in `from` where it shows the same point: depths must agree within
// `tolerance` (relative). What `from` does not show is not object. to_depth: size of `to`.
Mask warped_by_depth(const SeenView& from, const Camera& to, const Image<float>& to_depth,
                     float tolerance = 0.05f);

// Each pixel of `to_picture` (same size as from's) takes the mask where the flow says it came from.
Mask warped_by_flow(const SeenView& from, const Image<Rgb8>& to_picture);

}  // namespace splatcut
