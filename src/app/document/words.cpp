#include "app/document/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace splatcut
