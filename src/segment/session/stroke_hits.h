// What strokes hit of a whole scene.
//
// In: a stroke and its camera. Out: per point of a path the place on the surface that its pixel shows, or
// that of the nearest pixel within a eightieth of the picture's width that shows anything. A click is looked
// up in the camera's own pixels, a scribble in a picture of at most 320 pixels. Of a box: places on a grid of
// such a picture's pixels in it, without those that lie nearer or farther than what it is around by more than
// the box is large there; that lies as far away as a quarter of what the box shows or nearer. Cost: one
// drawing of the blocks that these pixels show.
//
// A path on the rest is asked about all along, not at its points alone: what lies in a box is the pieces of
// it that hit the box, each with its ends and its own points between.
#pragma once

#include <optional>
#include <vector>

#include "scene/raster/projected_view.h"
#include "segment/selection/stroke_replay.h"

namespace splatcut {

using StrokeHits = std::vector<std::optional<glm::vec3>>;  // world, per point of a path

StrokeHits stroke_hits(const Drawer& scene, const CameraStroke& stroke, const Job& job = {});

// The same path with points between its own, a pixel apart of the picture that a scribble is looked up in. A
// click, and a box, are as they are.
Stroke sampled(const CameraStroke& stroke);

// The stroke as it lies in the box: a path's pieces, whole where all of it does; a box as it is if any of it
// does. hits: of sampled(stroke). A gap that the ends of two pieces cover anyway is none.
Strokes pieces_in(const Box& box_world, const CameraStroke& stroke, const StrokeHits& hits);

}  // namespace splatcut
