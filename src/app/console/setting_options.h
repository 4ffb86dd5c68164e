// Settings that have no switch of their own, by name: --set NAME=VALUE. See segment/session/settings_table.h.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "segment/session/cut_settings.h"

namespace CLI {
class App;
}

namespace splatcut {

// Adds --preset and the repeatable --set.
void add_setting_options(CLI::App& command, std::string* preset, std::vector<std::string>* assignments);

// All settings by name, for reports: numbers, or words.
nlohmann::json values_json(const CutSettings& settings);

}  // namespace splatcut
