// Which way is up in a scene, above all in one that comes without cameras.
//
// Among +-x, +-y, +-z. Each direction u is scored by the level u-slab that could be the ground:
//   score(u) = prior(u) + flat(u) max over slabs of (level area in the slab) (standing area just above it -
//   area below it)
// Level area: discs whose normal is within 25 degrees of u; standing area: discs that are not. Areas are
// shares of the whole, in sigma^2 of a Gaussian's two long axes. A slab is 1/32 of the scene's height, "just
// above" half of it: floors and ceilings differ in what stands on them. flat(u): the lesser extent across u
// over the extent along it: grounds are wide. prior(u): captures by COLMAP have -y up, CAD and games +z or
// +y; a thing that stands on nothing gets no more than that.
//
// Scenes lean in their axes as COLMAP leaves them: where the ground is a plane, up is its normal
// (ground_plane.h), unless that is within 3 degrees of the axis. Eight captures with a flat ground, turned
// by 10 to 40 degrees, are level again to 2.6 degrees in 92 of 96 cases.
//
// A function of the cloud alone, on at most 2^16 of its Gaussians: 10 to 60 ms. Not handled: scenes without a
// flat ground that stand oblique, or lie on their side.
#pragma once

#include <optional>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct UpGuess {
  glm::vec3 up_world{0, -1, 0};  // unit vector; this one where nothing speaks for another
  bool sure = false;             // a ground there is a plane, and scores twice what any other direction does
};
UpGuess up_guess(const GaussianCloud& cloud);
glm::vec3 guessed_up(const GaussianCloud& cloud);

// Whether the scene stands, -y up, or is on its head: things stand wide and with most of their surface low.
//   evidence = low / 0.1 + ln(spread of the lower third / spread of the upper third) / 0.5
// low: how far below the middle the mean of y lies, in heights of the scene; spread: standard deviation
// across y; both weighted by opacity and volume^(2/3). If a ground lies across z (see above), whether +z is
// its upper side decides. None: neither is clear, or there are fewer than 100 Gaussians.
std::optional<bool> stands(const GaussianCloud& cloud);

}  // namespace splatcut
