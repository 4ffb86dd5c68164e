// The plane that a scene stands on, if it shows one: the table or the floor below what was captured.
//
// RANSAC (Fischler and Bolles 1981) over the centres of Gaussians that hide half of what is behind them: of
// planes through three of them, within 45 degrees of level, the one with the largest
//   share * (above - 3 below)
// share: of the centres within .005 of the scene's size of the plane; above, below: of the others. Once with
// the outer 4 % left out, once with the outer 20 %, once with 40 %: a table fills more of the inner ones, a
// floor of the outer. It must have a share of .15, or of .1 if another of the three is alike; the one of the
// largest share is taken, fitted to its centres by least squares. Of 25 captures 14 show one (share .15 to
// .71, the ground in all of them); the others have shares up to .13, in directions that differ.
//
// Same cloud, same plane; 3 to 50 ms. It knows nothing of slopes: what stands on one leans.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// Unit normal, on the side of up_world, which may be 45 degrees wrong. None: nothing flat is large enough.
std::optional<glm::vec3> ground_normal(const GaussianCloud& cloud, const glm::vec3& up_world);

}  // namespace splatcut
