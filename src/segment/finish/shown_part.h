// The part of a scene that an object's own pictures can show, with the object or with any of what lies around
// it taken away: for stages that draw the same views again and again, in scenes of any size.
//
// In: scene, labels, cameras. Out: a smaller scene that holds
//   what lies in the box around the positions of the labelled Gaussians, and
//   what shows in the rectangle around the object, wider by kSurroundingsPx, in one of the pictures, once all
//   that lies in the box is taken away.
// Taking away more can only show more of what stays: whichever Gaussians of the box a stage draws or leaves
// out there, all that shows is in the part, but for what gives such a picture less than 2^-17 px in all.
// Cost: one drawing of the scene a view. Same input, same bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/job.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

inline constexpr int kSurroundingsPx = 32;  // enough to know whose the places beside the object are

struct ShownPart {
  std::vector<std::uint32_t> row;  // index in the scene of each Gaussian, ascending
  GaussianCloud cloud;
  std::vector<std::uint8_t> labels;
};

// Indices of the labelled Gaussians, ascending.
std::vector<std::uint32_t> labelled_rows(std::span<const std::uint8_t> labels);

// Adds what each Gaussian shows in a rectangle of the view, px, to sums of one plane. shown: flags per
// Gaussian, 0 leaves it out; empty: all are drawn.
void add_shown_px(const Drawer& scene, const Camera& camera, const PixelRect& rect,
                  std::span<const std::uint8_t> shown, PlaneSums* sums, const Job& job);

// Cancelled: unspecified.
ShownPart shown_part(const Drawer& scene, std::span<const std::uint8_t> labels,
                     std::span<const Camera> cameras, const Job& job);

}  // namespace splatcut
