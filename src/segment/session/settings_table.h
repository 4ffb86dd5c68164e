// The settings by name: one table that `--set`, reports, checks and studies read.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "segment/session/cut_settings.h"

namespace splatcut {

enum class SettingFor {
  kPeople,       // who want it faster, smoother, or from another first mask
  kExperiments,  // that ask what a term is worth
};

struct Setting {
  std::string name;
  SettingFor whom = SettingFor::kPeople;
  std::string sentence;                                           // what it does
  std::string values;                                             // which ones it takes, in words
  std::function<bool(std::string_view value, CutSettings*)> set;  // false for any other value
  std::function<std::string(const CutSettings&)> get;             // as `set` reads it
};

// All of them, those for people first, in the order in which they are listed. One line of the table in the
// .cpp file each.
std::span<const Setting> settings_table();

// assignment: NAME=VALUE. Throws Error that lists the names, or the values, where it is none.
void set_setting(std::string_view assignment, CutSettings* settings);
void set_setting(std::string_view name, std::string_view value, CutSettings* settings);

// NAME=VALUE of what differs, in the table's order.
std::vector<std::string> differences(const CutSettings& settings, const CutSettings& from);

// A line per setting for people: name, values, sentence.
std::string settings_help();

}  // namespace splatcut
