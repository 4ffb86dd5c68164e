// From where to look first at a scene that comes without cameras.
//
// The subject is what was captured most finely, as splats are small where cameras were near: centre and
// radius are medians weighted by 1 / sigma. Candidates: all from outside; the subject from eight sides, from
// the best three of them also nearer, farther, lower and higher; and, unless one thing was captured, small or
// tall and alone, views from within in eight directions, from the middle and around it. Each is scored by
//   c  sharp share of the picture  (sharp share of what is covered)^2  (1 - share before the lens)^2
// Sharp: 1 / (1 + (s / 1.5 px)^2), s the footprint of a pixel's first Gaussian in a picture 160 px wide.
// c: of the subject, how much of it lies well inside the picture and is not hidden (a roof hides a room);
// constants for the others, from within less where all that is seen is near. A thing that stands alone,
// higher than wide, is to be seen from head to foot.
//
// A function of the cloud alone. Cost: 30 to 100 small pictures of at most 2^18 Gaussians, .1 to 1.3 s on two
// cores. Not handled: a subject that was captured from one side only is known by its sharpness alone.
#pragma once

#include <optional>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// From a little above, all of `bounds` in the picture with some air: how a scene is first framed.
Camera view_of_all(const Box& bounds, const glm::vec3& up_world, float fov_y_rad, int width_px,
                   int height_px);

// bounds: of the scene without its outliers. outside: the usual view. None where that shows the scene best.
std::optional<Camera> better_first_view(const GaussianCloud& cloud, const Box& bounds,
                                        const glm::vec3& up_world, const Camera& outside,
                                        const Job& job = {});

}  // namespace splatcut
