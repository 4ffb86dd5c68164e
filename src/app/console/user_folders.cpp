#include "app/console/user_folders.h"

#include <cstdlib>

namespace splatcut {

namespace {

std::filesystem::path xdg(const char* variable, const char* in_home) {
  // The specification has relative ones ignored.
  if (const char* folder = std::getenv(variable); folder && std::filesystem::path(folder).is_absolute())
    return std::filesystem::path(folder) / "splatcut";
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home && *home ? home : "/tmp") / in_home / "splatcut";
}

}  // namespace

std::filesystem::path config_folder() {
  return xdg("XDG_CONFIG_HOME", ".config");
}

std::filesystem::path state_folder() {
  return xdg("XDG_STATE_HOME", ".local/state");
}

std::filesystem::path cache_folder() {
  return xdg("XDG_CACHE_HOME", ".cache");
}

}  // namespace splatcut
