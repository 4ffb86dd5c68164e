#include "app/document/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace splatcut {

std::string grouped(std::size_t n) {
  if (n < 1000) return fmt::format("{}", n);
  return fmt::format("{},{:03}", grouped(n / 1000), n % 1000);
}

std::string gaussians_text(std::size_t n) {
  return grouped(n) + (n == 1 ? " Gaussian" : " Gaussians");
}

std::string length_format(float length) {
  const float size = std::abs(length);
  if (!(size > 0)) return "%.0f";
  if (size < 1e-4f || size >= 1e9f) return "%.2e";
  return fmt::format("%.{}f", std::max(0, 2 - static_cast<int>(std::floor(std::log10(size)))));
}

std::string as_sentence(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

std::string ms_text(double ms) {
  return ms < 1000 ? fmt::format("{:.0f} ms", ms) : fmt::format("{:.1f} s", ms / 1000);
}

std::string length_text(float length) {
  const float size = std::abs(length);
  if (!(size > 0)) return "0";
  if (size >= 1000 && size < 1e9f)
    return fmt::format("{}{}", length < 0 ? "-" : "", grouped(static_cast<std::size_t>(std::lround(size))));
  if (size < 1e-4f || size >= 1e9f) return fmt::format("{:.2e}", length);
  return fmt::format("{:.{}f}", length, std::max(0, 2 - static_cast<int>(std::floor(std::log10(size)))));
}

std::string scene_name(const std::filesystem::path& scene) {
  const std::filesystem::path& path = scene.has_filename() ? scene : scene.parent_path();  // "folder/"
  const std::string name = path.filename().string();
  if (name != "meta.json" && name != "lod-meta.json") return name;
  std::error_code ignored;
  const std::filesystem::path whole = std::filesystem::absolute(path, ignored);
  const std::string folder = whole.lexically_normal().parent_path().filename().string();
  return folder.empty() ? name : folder;
}

std::string telling_folder(const std::filesystem::path& scene) {
  std::error_code ignored;
  std::filesystem::path folder = std::filesystem::absolute(scene, ignored).lexically_normal().parent_path();
  std::filesystem::path iteration;
  for (std::string name = folder.filename().string(); name == "point_cloud" || name.starts_with("iteration_");
       name = folder.filename().string()) {
    if (name != "point_cloud") iteration = name;
    folder = folder.parent_path();
  }
  return (iteration.empty() ? folder.filename() : folder.filename() / iteration).string();
}

std::string name_in_folder(const std::filesystem::path& scene) {
  const std::string folder = telling_folder(scene), name = scene_name(scene);
  return folder == name ? name : (std::filesystem::path(folder) / name).string();
}

bool has_common_name(const std::filesystem::path& scene) {
  constexpr std::array<std::string_view, 7> kCommon = {"point_cloud", "scene", "splat", "splats",
                                                       "gaussians",   "model", "output"};
  const std::string name = scene_name(scene);
  return std::ranges::find(kCommon, std::string_view(name).substr(0, name.find('.'))) != kCommon.end();
}

}  // namespace splatcut
