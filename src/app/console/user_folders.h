// Where the program keeps what belongs to the user, by the XDG base directory specification.
#pragma once

#include <filesystem>

namespace splatcut {

std::filesystem::path config_folder();  // $XDG_CONFIG_HOME/splatcut, or ~/.config/splatcut
std::filesystem::path state_folder();   // $XDG_STATE_HOME/splatcut, or ~/.local/state/splatcut
std::filesystem::path cache_folder();   // $XDG_CACHE_HOME/splatcut, or ~/.cache/splatcut

}  // namespace splatcut
