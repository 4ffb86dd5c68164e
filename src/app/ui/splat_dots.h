// Some Gaussians as dots in their own colours: what is dragged, before it is drawn as splats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/placing/export_placement.h"
#include "app/ui/ui_context.h"

namespace splatcut {

// At most about `most` of those that are flagged, spread evenly: every n-th.
std::vector<std::uint32_t> some_of(std::span<const std::uint8_t> flags, std::size_t most);

// Far ones first, as large as their splats within limits. camera: its pixels are points of the window; only
// what lies within the area is drawn.
void draw_dots(const GaussianCloud& cloud, std::span<const std::uint32_t> which, const Similarity& to,
               const Camera& camera, const UiRect& area);

}  // namespace splatcut
