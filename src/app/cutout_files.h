// What `splatcut cut` leaves behind: scenes, labels, pictures, report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/output_folder.h"
#include "scene/scene_file.h"
#include "segment/pipeline.h"

namespace splatcut {

// object.png, rest.png, tint.png from `camera`, masks.png of the views.
void write_cutout_pictures(const OutputFolder& folder, const GaussianCloud& cloud, const Camera& camera,
                           const PipelineReport& report);

// object.ply, rest.ply (for .ply sources rows unchanged), labels.u8 in file order.
void write_cutout_scenes(const OutputFolder& folder, const Scene& scene, const std::vector<std::uint8_t>& labels);

nlohmann::json report_json(const Scene& scene, const PipelineReport& report, const nlohmann::json& settings, double total_ms);

double peak_rss_mb();

}  // namespace splatcut
