// The part of what an object stands on that none of twelve views ever showed: the bottom of the hole that it
// leaves.
//
// In: scene, labels, cameras of the capture. Views and plane are those of fill.h: the views are cameras of
// the capture where enough of those show the object, else an orbit around it. The plane is divided into cells
// of 1/24 of the object's radius, four radii to each side. A view from above the plane shows a cell where, in
// the pixel of its middle, there is no object, and nothing that is more than .05 radii above the plane: what
// is seen through hides no ground. A cell is never seen where no such view shows it, at least one has the
// object there, and it hangs together with such cells below the object; what is no wider than four cells is
// noise. Out: area and outline of these cells, if at least half of that outline runs within two cells of
// ground that a view shows: else the plane is none that the object stands on, and nothing is known. Cost: a
// drawing of the scene a view. Same input, same bits. It knows nothing of ground that is not flat, nor of
// what hides the ground beside the object: that was there before.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

struct UnseenGround {
  std::string why_not;  // a sentence without a full stop; empty: it is known
  double area = 0;      // scene units squared
  std::vector<std::pair<glm::vec3, glm::vec3>> outline_world;  // pieces between its cells and others
};

// Of the labelled, at least one. cameras: of the capture, may be empty. Cancelled: unspecified.
UnseenGround unseen_ground(const Drawer& scene, std::span<const std::uint8_t> labels,
                           const glm::vec3& up_world, std::span<const Camera> cameras, const Job& job);

}  // namespace splatcut
