// The standard simulated user of interactive segmentation: clicks where the error is largest.
// Source: the protocol of Xu et al., Deep Interactive Object Selection, 2016.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/image.h"
#include "segment/seeds.h"

namespace splatcut {

// The next click on the way from `mask` to `truth`, in their pixels: the middle (farthest from the border)
// of the largest wrong region; an empty mask gives the middle of the truth. None where nothing is wrong.
std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask);

// The same robot with an unsteady hand: any pixel of that region that is at least half as deep inside as its
// middle, by chance. draw: which chance; 0 is the steady robot.
std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask, std::uint64_t draw);

}  // namespace splatcut
