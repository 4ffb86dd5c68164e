#include "app/console/user_folders.h"

#include <pwd.h>
#include <unistd.h>

#include <cstdlib>

namespace splatcut {

namespace {

std::filesystem::path xdg(const char* variable, const char* in_home) {
  // The specification has relative ones ignored.
  if (const char* folder = std::getenv(variable); folder && std::filesystem::path(folder).is_absolute())
    return std::filesystem::path(folder) / "splatcut";
  const char* home = std::getenv("HOME");
  if (!home || !*home) {
    const passwd* user = ::getpwuid(::getuid());
    // Nothing is kept there. In /tmp others could put files for the program to read.
    home = user && user->pw_dir && *user->pw_dir ? user->pw_dir : "/nonexistent";
  }
  return std::filesystem::path(home) / in_home / "splatcut";
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
