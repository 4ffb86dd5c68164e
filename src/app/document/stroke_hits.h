// What strokes are made on.
#pragma once

#include <functional>

#include "app/document/document.h"
#include "scene/raster/rasterizer.h"
#include "segment/selection/stroke_replay.h"

namespace splatcut {

// Draws a part of the picture that a camera shows of the visible Gaussians (null: all), with its first hits.
using DrawnPart =
    std::function<RasterOutput(const Camera& camera, const PixelRect& part, const Flags& visible)>;

// Draws the cloud so. blocks: those of the cloud.
DrawnPart drawn_part_of(std::shared_ptr<const GaussianCloud> cloud,
                        std::shared_ptr<const CloudBlocks> blocks);

// Gaussians that a stroke is made on: the one under its first point; of a box those that show in it, one a
// pixel of a small picture.
std::vector<std::int32_t> hits_of(const CameraStroke& stroke, const DrawnPart& drawn);

// The same of each stroke that marks the object.
std::vector<std::vector<std::int32_t>> hits_of(const ObjectItem& object, const DrawnPart& drawn);

}  // namespace splatcut
