// From the reference view to a label per Gaussian: the stages of ARCHITECTURE.md from the first mask on.
//
// In: a scene with what is prepared of it, the reference with its strokes (or a mask of it).
// Out: labels (1 = object), the views used with their masks, likelihood, energy, milliseconds per stage.
// Source: Jain et al., GaussianCut, NeurIPS 2024; the propagator is ours: labels of a 3D cut rendered into
// the next view are its mask. Where views around the object are asked, they are added until the labels stop
// changing.
// Expected outcomes (nothing found, cancelled) are in `outcome`. Called by Session alone, see session.h.
#pragma once

#include <vector>

#include "segment/session/cut_result.h"
#include "segment/session/cut_task.h"

namespace splatcut {

// The cut from the reference: of the request, strokes in other views and views left out play no part.
CutResult cut_from_reference(const CutTask& task, const OnSnapshot& on_snapshot);

// The first mask alone, in the size of limited_to_width(reference, work_width_px), or larger where the object
// is small. Cancelled: empty, of that size.
Mask first_mask_of(const CutTask& task);

// trim() by the views that count. Returns how many Gaussians left the object.
std::size_t trim_to_views(const Drawer& drawer, const std::vector<ViewReport>& views,
                          const CutSettings& settings, std::vector<std::uint8_t>* labels, const Job& job);

}  // namespace splatcut
