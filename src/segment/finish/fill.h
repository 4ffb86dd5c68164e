// The hole that an object leaves in what it stood on, filled with a copy of a piece of the surface beside it.
//
// What no view ever showed cannot be known; this continues a flat surface, where there is one. All of it is
// invented, and the report says so. In the plane that the object stands on (support_plane.h), seen from far
// above:
//   layer   Gaussians of the rest that draw pixels of the surface: in a dozen views, half of what they draw
//           lies within .05 of the object's radius of the plane, and it is no farther off than .2 itself.
//           What no view shows below the object has no say.
//   hole    cells that the object covers from above and that are bare or shaded. Bare: the layer's alpha is
//           below .7, and in 10 of 16 directions the surface lies around. Shaded: darker than the surface .6
//           to 1.2 radii off, by its spread there and by .06. The shade that hangs together with these cells
//           belongs to the hole as far as .6 of its side, with three cells of penumbra.
//   pieces  The hole is moved by whole cells of the map to where the layer covers much of it and nothing
//           stands. Of the places that fill most, the one is taken whose colours along the rim are most like
//           those along the hole's, three quarters of the mean difference aside. Then the same is done for
//           what is left, up to 24 times.
//   copies  of the layer's Gaussians there, and of what lies within .2 radii below it and keeps it from being
//           seen through, moved back. The difference along the rim, carried inwards by the
//           Laplace equation (Perez, Gangnet, Blake, Poisson Image Editing, 2003), is added to their colours.
// Copies that would reach beyond the surface are left out. The layer's own Gaussians in the hole leave. Where
// copies cover less than .7 of the hole, or the rims differ by more than .22, nothing is changed; nor where
// less than .12 of what surrounds the object lies in the plane. Cost: two
// drawings of the scene for each of those views, three small ones, and the search, .6 s at most on the
// captures tried. Same input, same bits, on any number of threads. Cancelled: unspecified.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/job.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/finish/forget.h"
#include "segment/finish/own_views.h"

namespace splatcut {

struct SurfacePatch {
  std::string why_not;  // a sentence without a full stop; empty: there is a patch
  RestChanges changes;  // ghosts: what is replaced; given_back: the copies
  int pieces = 0;
  double area = 0;                                             // of the hole, scene units squared
  std::vector<std::pair<glm::vec3, glm::vec3>> outline_world;  // pieces around the hole
  double rim_error = 0;  // of the colours along the rim before they were fitted, root mean square
};

// gone: indices of Gaussians that leave with the object (forget.h).
SurfacePatch fill_surface(const Drawer& scene, std::span<const std::uint8_t> labels,
                          std::span<const std::uint32_t> gone, const glm::vec3& up_world,
                          std::span<const Camera> cameras, const Job& job);

}  // namespace splatcut
