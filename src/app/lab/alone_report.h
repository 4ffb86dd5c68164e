// The measures of alone_score.h in reports and tables.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/measure/alone_score.h"

namespace splatcut {

// {"alone": as its Gaussians are, "clean": with clean edges, "rest", "clean_rest": of the scene}.
nlohmann::json cutout_json(const CutoutScore& score);

// Two rows a scene of eval.json for the object, two for the rest, and the mean's.
void print_alone(const nlohmann::json& result);

}  // namespace splatcut
