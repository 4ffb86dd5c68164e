// Points that lie apart from all else: single Gaussians in the air around a thing, or far behind it.
//
// In: positions, any unit. Out: flags, or the box of the others. A grid of cells, up to 16 across the box of
// the middle eight tenths and fewer where points are few, so that a surface hangs together in it; cells with
// enough points that touch, by a corner too, are a piece. A point is a stray unless its cell, or one that
// touches it, belongs to a piece of kLeastShare of the points. The largest piece is never stray. Cost:
// linear, 100 ms a million points. Not handled: a swarm of strays as dense as the thing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// One byte a point, 1 = stray.
std::vector<std::uint8_t> strays_of(std::span<const glm::vec3> positions);

// The points that are no strays, of every n-th where there are more than `most`.
std::vector<glm::vec3> without_strays(std::span<const glm::vec3> positions, std::size_t most = 50000);

// Where labelled Gaussians show, strays left out: their centres, and the points of their axes at which an
// opaque one is half as dense as in its middle. Of every n-th where there are more than `most`.
std::vector<glm::vec3> shown_points(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
                                    std::size_t most = 8000);

// The box of all that shows of a cloud but strays: Gaussians of an opacity below a tenth do not count.
Box solid_bounds(const GaussianCloud& cloud);

}  // namespace splatcut
