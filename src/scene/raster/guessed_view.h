// Scenes that come without cameras: which way is up, and from where to look first.
//
// Up, among +-x, +-y, +-z. Each direction u is scored by the level u-slab that could be the ground:
//   score(u) = prior(u) max over slabs of (level area in the slab) (standing area just above it - area below
//   it)
// Level area: discs whose normal is within 25 degrees of u; standing area: discs that are not. Areas are
// shares of the whole, in sigma^2 of a Gaussian's two long axes. prior(u): captures by COLMAP have -y up, CAD
// and games +z or +y. A slab is 1/32 of the scene's height, "just above" half of it: floors and ceilings
// differ in what stands on them.
//
// First view: the one from outside that frames all, unless the Gaussians seen from there are blurs: a room
// seen through its walls. Then from another side, or from within, in the direction of eight in which most of
// the picture is sharp and not too near. Sharp: 1 / (1 + (s / 1.5 px)^2), s the footprint of a pixel's first
// Gaussian in a picture 160 px wide.
//
// Functions of the cloud alone, on at most 2^16 of its Gaussians (up) or in 1 to 24 small pictures (view): 5
// to 15 ms, and 10 to 600 ms on two cores. Not handled: scenes that stand oblique, several rooms.
#pragma once

#include <optional>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// Unit vector. (0, -1, 0) where nothing speaks for another.
glm::vec3 guessed_up(const GaussianCloud& cloud);

// From a little above, all of `bounds` in the picture with some air: how a scene is first framed.
Camera view_of_all(const Box& bounds, const glm::vec3& up_world, float fov_y_rad, int width_px,
                   int height_px);

// bounds: of the scene without its outliers. outside: the usual view. None where that shows the scene well.
std::optional<Camera> better_first_view(const GaussianCloud& cloud, const Box& bounds,
                                        const glm::vec3& up_world, const Camera& outside,
                                        const Job& job = {});

}  // namespace splatcut
