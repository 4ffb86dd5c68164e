#include "app/ui/settings.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/atomic_file.h"

namespace splatcut {

Settings load_settings(const std::filesystem::path& file) {
  Settings s;
  std::ifstream in(file);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object()) return s;
  try {
    s.width = std::clamp(json.value("width", s.width), 640, 8192);
    s.height = std::clamp(json.value("height", s.height), 480, 8192);
    if (const auto at = json.find("position"); at != json.end())
      s.position = {at->at(0).get<int>(), at->at(1).get<int>()};
    s.maximized = json.value("maximized", s.maximized);
    s.dark = json.value("dark", s.dark);
    s.hint_wanted = json.value("hint", s.hint_wanted);
    s.ui_scale = std::clamp(json.value("ui_scale", s.ui_scale), 0.5f, 4.0f);
    s.view.brush_px = std::clamp(json.value("brush_px", s.view.brush_px), 1.0f, 400.0f);
    s.view.tint = json.value("tint", s.view.tint);
    s.view.outline = json.value("outline", s.view.outline);
    for (const std::string& path : json.value("recent", std::vector<std::string>()))
      s.recent.emplace_back(path);
  } catch (const nlohmann::json::exception&) {
    return {};
  }
  std::erase_if(s.recent, [](const std::filesystem::path& path) { return !std::filesystem::exists(path); });
  return s;
}

void save_settings(const std::filesystem::path& file, const Settings& s) {
  nlohmann::json recent = nlohmann::json::array();
  for (const auto& path : s.recent) recent.push_back(path.string());
  nlohmann::json json = {{"width", s.width},       {"height", s.height},
                         {"dark", s.dark},         {"hint", s.hint_wanted},
                         {"ui_scale", s.ui_scale}, {"brush_px", s.view.brush_px},
                         {"tint", s.view.tint},    {"outline", s.view.outline},
                         {"recent", recent},       {"maximized", s.maximized}};
  if (s.position) json["position"] = {s.position->x, s.position->y};
  std::filesystem::create_directories(file.parent_path());
  write_text_file(file, json.dump(2) + "\n");
}

}  // namespace splatcut
