// The object in the reference view: its mask there, and what the parts say of it in space.
//
// By parts, strokes are replayed and a given mask is completed by what it hides; the labels of that are the
// prior of every cut. Without parts, the mask grows from the strokes in the picture alone.
#pragma once

#include <optional>
#include <vector>

#include "segment/session/cut_result.h"
#include "segment/session/cut_task.h"

namespace splatcut {

struct ReferenceMask {
  Mask mask;
  Image<float> median_depth;  // of the whole scene; empty where it was not drawn
};

// camera: the reference's, in the size to look at. Sets the result's labels, prior and what it says of the
// first click. Nothing: cancelled.
std::optional<ReferenceMask> reference_mask(const CutTask& task, const Camera& camera, CutResult* result);

// What strokes are replayed with, and all of them in their order.
ReplayOptions replay_options(const CutRequest& request, const CutSettings& settings, const PartModel& model);
std::vector<CameraStroke> strokes_in_order(const CutRequest& request);

}  // namespace splatcut
