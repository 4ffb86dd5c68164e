#include "app/console/setting_options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "segment/session/settings_table.h"

namespace splatcut {

void add_setting_options(CLI::App& command, std::string* preset, std::vector<std::string>* assignments) {
  std::string sentences = "Settings by name: " + preset_names();
  command.add_option("--preset", *preset, sentences);
  command
      .add_option("--set", *assignments,
                  "NAME=VALUE: a setting of the energy or the views by its name (a wrong one lists them)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

nlohmann::json values_json(const CutSettings& settings) {
  nlohmann::json values;
  for (const Setting& setting : settings_table()) {
    const std::string text = setting.get(settings);
    const nlohmann::json number = nlohmann::json::parse(text, nullptr, false);
    values[setting.name] = number.is_number() ? number : nlohmann::json(text);
  }
  return values;
}

}  // namespace splatcut
