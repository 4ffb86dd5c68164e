// Makes solid what lets a background through only because the scene behind it is gone: fur, glaze, one thin
// layer of splats.
//
// Per Gaussian, over the pixels more than 2 px inside of its own views' masks: t, the mean of 1 - alpha of
// the object alone, weighted by alpha T. Where t > .03 and more than .9 of what it shows lies in there:
//   opacity = min(.99, 1 - (1 - opacity)^e),  e = clamp(ln .02 / ln t, 1, 6)
// so that the layers together let through about a fiftieth. Cost: two drawings of the object a view.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/job.h"
#include "segment/finish/own_views.h"

namespace splatcut {

// Returns how many Gaussians were made solid.
std::size_t make_solid(std::span<const OwnView> views, const std::vector<std::uint8_t>& kept,
                       GaussianCloud* object, const Job& job);

}  // namespace splatcut
