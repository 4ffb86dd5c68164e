// Where and how large a cut writes its Gaussians, by --origin, --up and --scale-by.
//
// --scale-by names two pixels of the reference view and the metres between the places that they show. A place
// is found as that of a click (segment/session/stroke_hits.h); the factor is metres over scene units.
#pragma once

#include "app/cli/cutout_files.h"
#include "app/console/camera_options.h"
#include "app/placing/export_placement.h"

namespace splatcut {

// Throws Error for a known length that is none: not five numbers, metres not larger than 0, a pixel outside
// of the picture or one that shows nothing, two pixels of one place. Cancelled: unspecified.
ExportPlacement placement_of(const CutoutOptions& options, const Drawer& scene, const Camera& camera,
                             const Job& job);

// Throws Error, naming where it was given, for a factor that makes lengths no numbers.
void check_factor(float factor, const std::string& where);

// What the files say of up: it is known, or the placement says where it points. None where it is a guess.
std::optional<glm::vec3> up_to_write(const ChosenCamera& chosen, const ExportPlacement& placement);

}  // namespace splatcut
