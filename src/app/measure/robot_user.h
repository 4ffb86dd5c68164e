// The standard simulated user of interactive segmentation: clicks where the error is largest.
// Source: the protocol of Xu et al., Deep Interactive Object Selection, 2016.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "segment/masks/seeds.h"

namespace splatcut {

// The largest wrong region of a picture and what its pixels should be; an empty mask of no pixels where
// nothing is wrong. Missing before extra where both are as large.
struct WrongRegion {
  Mask region;
  std::size_t pixels = 0;
  SeedLabel label = SeedLabel::kObject;
};
WrongRegion wrong_region(const Mask& truth, const Mask& mask);

// Every wrong region that is a detail at least: its middle lies that many pixels from its border, and it has
// four times their square. Missing ones before extra ones.
std::vector<WrongRegion> wrong_details(const Mask& truth, const Mask& mask, float least_px);

// The middle of the region, the pixel farthest from its border, the first one where there are several; with
// an unsteady hand (draw != 0) any pixel at least half as deep inside, by chance. None for an empty region.
std::optional<Stroke> click_in(const WrongRegion& wrong, std::uint64_t draw = 0);

// The next click on the way from `mask` to `truth`, in their pixels: the middle (farthest from the border)
// of the largest wrong region; an empty mask gives the middle of the truth. None where nothing is wrong.
std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask);

// The same robot with an unsteady hand: any pixel of that region that is at least half as deep inside as its
// middle, by chance. draw: which chance; 0 is the steady robot.
std::optional<Stroke> robot_click(const Mask& truth, const Mask& mask, std::uint64_t draw);

// The box that just holds the mask, each of its sides moved outwards by `margin` of the box's extent that way
// (below 0: into it); with an unsteady hand (draw != 0) each by another share of it, by chance between 0 and
// 2 margin. It may leave the picture. None for an empty mask.
std::optional<Stroke> robot_box(const Mask& truth, float margin, std::uint64_t draw = 0);

}  // namespace splatcut
