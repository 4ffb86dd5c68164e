// What is remembered between runs: window, what the settings page sets, recent files. A file that cannot be
// read is ignored.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>

#include "app/document/view_state.h"
#include "app/window/application.h"

namespace splatcut {

struct Settings {
  int width = 1440, height = 900;      // screen coordinates, as GLFW has them
  std::optional<glm::ivec2> position;  // of the window's contents; where the system likes without
  bool maximized = false;
  bool dark = true, hint_wanted = true;
  float ui_scale = 1;
  std::vector<std::filesystem::path> recent;
  std::filesystem::path export_folder;  // of the last export; empty: none was made
  ViewState view;  // brush, speed, tints and outline of it; tools and display modes start afresh

  bool operator==(const Settings&) const = default;
};

Settings load_settings(const std::filesystem::path& file);
void save_settings(const std::filesystem::path& file, const Settings& settings);  // throws Error

// Sets the program as it was kept, but for the window's place.
void use_settings(const Settings& settings, Application* app);
// As the program is set now; the window's place is that of `kept`.
Settings settings_of(Application& app, Settings kept);

// Writes them as they change, so that a killed program loses none.
class SettingsKeeper {
 public:
  explicit SettingsKeeper(std::filesystem::path file) : file_(std::move(file)), kept_(load_settings(file_)) {}
  const Settings& kept() const { return kept_; }
  void keep(const Settings& now);  // throws Error, and tries again when it is called again

 private:
  std::filesystem::path file_;
  Settings kept_;
};

}  // namespace splatcut
