#include "app/window/settings.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

Settings load_settings(const std::filesystem::path& file) {
  Settings s;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return s;
  try {
    const nlohmann::json json = json_of_file(file);
    s.width = std::clamp(json.value("width", s.width), 640, 8192);
    s.height = std::clamp(json.value("height", s.height), 480, 8192);
    if (const auto at = json.find("position"); at != json.end())
      s.position = {at->at(0).get<int>(), at->at(1).get<int>()};
    s.maximized = json.value("maximized", s.maximized);
    s.dark = json.value("dark", s.dark);
    s.hint_wanted = json.value("hint", s.hint_wanted);
    s.ui_scale = std::clamp(json.value("ui_scale", s.ui_scale), 0.5f, 4.0f);
    s.view.brush_px = std::clamp(json.value("brush_px", s.view.brush_px), kLeastBrushPx, kMostBrushPx);
    s.view.fly_speed = std::clamp(json.value("fly_speed", s.view.fly_speed), kLeastKeptSpeed, kMostKeptSpeed);
    s.view.tint = json.value("tint", s.view.tint);
    s.view.outline = json.value("outline", s.view.outline);
    s.view.web_low_pass = json.value("web_low_pass", s.view.web_low_pass);
    for (const std::string& path : json.value("recent", std::vector<std::string>()))
      s.recent.emplace_back(path);
    s.export_folder = json.value("export_folder", "");
  } catch (const nlohmann::json::exception&) {
    return {};
  } catch (const Error&) {
    return {};
  }
  std::erase_if(s.recent, [](const std::filesystem::path& path) {
    std::error_code failure;
    return !std::filesystem::exists(path, failure);
  });
  return s;
}

void save_settings(const std::filesystem::path& file, const Settings& s) {
  nlohmann::json recent = nlohmann::json::array();
  for (const auto& path : s.recent) recent.push_back(path.string());
  nlohmann::json json = {{"width", s.width},
                         {"height", s.height},
                         {"dark", s.dark},
                         {"hint", s.hint_wanted},
                         {"ui_scale", s.ui_scale},
                         {"brush_px", s.view.brush_px},
                         {"fly_speed", s.view.fly_speed},
                         {"tint", s.view.tint},
                         {"outline", s.view.outline},
                         {"recent", recent},
                         {"export_folder", s.export_folder.string()},
                         {"maximized", s.maximized},
                         {"web_low_pass", s.view.web_low_pass}};
  if (s.position) json["position"] = {s.position->x, s.position->y};
  std::filesystem::create_directories(file.parent_path());
  write_text_file(file, json_text(json, 2) + "\n", PowerCut::kMayLeaveNone);  // the window waits for it
}

void use_settings(const Settings& settings, Application* app) {
  UiState& state = app->interface().state();
  state.dark = settings.dark;
  state.ui_scale = settings.ui_scale;
  state.hint_wanted = settings.hint_wanted;
  state.recent = settings.recent;
  app->studio().begin_exports_in(settings.export_folder);
  app->studio().apply(SetView{settings.view});
}

Settings settings_of(Application& app, Settings kept) {
  const UiState& state = app.interface().state();
  kept.dark = state.dark;
  kept.ui_scale = state.ui_scale;
  kept.hint_wanted = state.hint_wanted;
  kept.recent = state.recent;
  kept.export_folder = app.studio().exports().folder();
  set_what_is_kept(app.studio().view(), &kept.view);
  return kept;
}

void SettingsKeeper::keep(const Settings& now) {
  if (now == kept_) return;
  save_settings(file_, now);
  kept_ = now;
}

}  // namespace splatcut
