// The fitted model of parts as a file, for experiments: {"splatcut_part_model": 1, "weights": {NAME:
// NUMBER}}.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "segment/superpoints/part_model.h"

namespace splatcut {

nlohmann::json part_model_json(const PartModel& model);

// What the file does not name stays as it is shipped. Throws Error for another version, or a name that is no
// weight's.
PartModel load_part_model(const std::filesystem::path& path);

}  // namespace splatcut
