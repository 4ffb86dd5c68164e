// Settings that have no switch of their own, by name: --set NAME=VALUE of `cut` and `eval`, for experiments.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "segment/session/cut_settings.h"

namespace CLI {
class App;
}

namespace splatcut {

struct TuningOption {
  std::string name;
  std::string values;                                             // which ones it takes, in words
  std::function<bool(std::string_view value, CutSettings*)> set;  // false for any other value
};

// All of them, in the order in which they are listed to the user. One line of the table in the .cpp file
// each.
const std::vector<TuningOption>& tuning_options();

// assignment: NAME=VALUE. Throws Error that lists the names, or the values, where it is none.
void set_tuning_option(std::string_view assignment, CutSettings* options);

// Adds the repeatable --set; what cannot be set is wrong usage.
void add_tuning_options(CLI::App& command, std::vector<std::string>* assignments);

}  // namespace splatcut
