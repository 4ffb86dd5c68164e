// The files that `splatcut cut` writes: scenes, labels, pictures, report.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/cli/cutout_object.h"
#include "app/console/output_folder.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/projected_view.h"
#include "segment/session/cut_result.h"

namespace splatcut {

// object.png, rest.png, tint.png from `camera`, masks.png of the views.
void write_cutout_pictures(const OutputFolder& folder, const Drawer& scene, const Camera& camera,
                           const CutResult& report, const CutoutObject& object);

struct PictureNames {
  std::string object = "object.png", tint = "tint.png", masks = "masks.png";
};
// The same without rest.png.
void write_object_pictures(const OutputFolder& folder, const Drawer& scene, const Camera& camera,
                           const CutResult& report, const CutoutObject& object,
                           const PictureNames& names = {});

// The Gaussians whose flag in `shown` is 1, all where it is empty, on nothing.
void write_cutout_picture(const std::filesystem::path& path, const Drawer& scene, const Camera& camera,
                          std::span<const std::uint8_t> shown);

// A byte for each row of the file, 0 for rows that the cloud lacks.
void write_labels(const std::filesystem::path& path, const Scene& scene,
                  const std::vector<std::uint8_t>& labels);

// NAME.ply and NAME.labels.u8.
void write_object_files(const OutputFolder& folder, const Scene& scene, const std::string& name,
                        const CutoutObject& object, const std::vector<std::uint8_t>& labels);

// object.ply, rest.ply (for .ply sources rows unchanged; without Gaussians where all are the object's),
// labels.u8 in file order.
void write_cutout_scenes(const OutputFolder& folder, const Scene& scene,
                         const std::vector<std::uint8_t>& labels, const CutoutObject& object);

// The report's entries for the whole run: version, settings, scene, time, memory.
nlohmann::json run_json(const Scene& scene, const nlohmann::json& settings, double total_ms);
// Its entries for one object: views, cut, stages.
nlohmann::json object_json(const CutResult& report);
// Both.
nlohmann::json report_json(const Scene& scene, const CutResult& report, const nlohmann::json& settings,
                           double total_ms);

double peak_rss_mb();

}  // namespace splatcut
