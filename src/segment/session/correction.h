// Strokes in a view other than the reference: what the labels show there, and what the strokes say instead.
#pragma once

#include <cstdint>
#include <vector>

#include "core/job.h"
#include "scene/raster/projected_view.h"
#include "segment/session/cut_request.h"
#include "segment/session/cut_settings.h"

namespace splatcut {

// Masks: of the camera's size. Confirming strokes count as changes: later views must not undo them.
struct Correction {
  Camera camera;
  Mask mask, added, removed;
};

// labels: of the cut so far. Camera: limited to the settings' work width.
Correction corrected(const Drawer& drawer, const StrokedView& view, const std::vector<std::uint8_t>& labels,
                     const CutSettings& settings, const Job& job);

// Adds what was added and removed, `weight` times.
void add_weighted(const Drawer& drawer, const Correction& correction, std::int64_t weight, bool whole_pixels,
                  const Job& job, MaskedSums* sums);

}  // namespace splatcut
