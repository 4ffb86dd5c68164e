// What the last stroke changed of an object, as views around it show it, and which of that nobody can have
// seen from where the stroke was made.
//
// In: scene, labels before and after, the view with the stroke. Out, per view: pixels that show what left the
// object or came to it, and whether the view is to be looked at for what was out of the stroke's sight: in
// the stroke's view a Gaussian g covers less than kLeastShare of the surface that it covers here,
//   A_g (z / f)^2,   A_g: sum of alpha T over the picture, px;  z: depth;  f: focal length, px
// Compared with the view itself, as many Gaussians lie upon each other at a surface: the deeper of them show
// little from anywhere. Cost: a drawing of the scene for the stroke's view, two a view. Same input, same
// bits.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "app/picture/cut_run.h"
#include "core/job.h"
#include "scene/raster/projected_view.h"
#include "segment/session/cut_request.h"

namespace splatcut {

// A view of the change; pictures of the camera's size.
struct ChangeSeen {
  Mask object, left, came;  // what the object is now; what it lost; of `object`, what is new
  std::string doubt;        // see ViewCard::doubt
  OpenDoubt open;           // what the doubt is of; empty without one
};

// Refers to scene and labels.
class StrokeChange {
 public:
  // before, after: labels of the scene's Gaussians, of one length; not all 0. Cancelled: unspecified.
  StrokeChange(const Drawer& scene, const StrokedView& made_in, std::span<const std::uint8_t> before,
               std::span<const std::uint8_t> after, const Job& job);

  // camera: of a thumbnail, 160 pixels wide. Cancelled: unspecified.
  ChangeSeen seen_from(const Camera& camera, const Job& job) const;

 private:
  std::vector<double> covered_from(const Camera& camera, std::span<const std::uint8_t> displayed,
                                   const Job& job) const;

  Drawer scene_;
  std::span<const std::uint8_t> before_, after_;
  std::vector<std::uint8_t> either_;
  std::vector<double> covered_;  // of the surface, by each Gaussian in the stroke's view, scene units squared
};

}  // namespace splatcut
