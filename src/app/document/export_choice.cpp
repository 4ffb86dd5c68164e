#include "app/document/export_choice.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "app/document/words.h"

namespace splatcut {

namespace {

bool can_be_written(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_directory(folder, ignored) &&
         ::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

bool fills_hole(const ExportChoice& choice) {
  return choice.fill_hole && choice.what == ExportWhat::kRest;
}

}  // namespace

std::filesystem::path folder_to_write(const std::filesystem::path& wanted) {
  const char* home = std::getenv("HOME");
  if (can_be_written(wanted) || !home || !*home) return wanted;
  for (const std::filesystem::path& folder :
       {std::filesystem::path(home) / "Documents", std::filesystem::path(home)})
    if (can_be_written(folder)) return folder;
  return wanted;
}

std::string proposed_path(const ExportChoice& choice, const std::filesystem::path& scene,
                          const ObjectItem* object) {
  const std::filesystem::path folder = choice.path.empty()
                                           ? folder_to_write(std::filesystem::absolute(scene).parent_path())
                                           : std::filesystem::path(choice.path).parent_path();
  std::string stem = scene_name(scene);
  stem = stem.substr(0, stem.find('.'));
  std::string name = choice.what == ExportWhat::kRest         ? "rest"
                     : choice.what == ExportWhat::kScene      ? "scene"
                     : choice.what == ExportWhat::kAllObjects ? "objects"
                     : object                                 ? object->name
                                                              : "object";
  for (char& c : name)
    if (c == ' ' || c == '/') c = '_';
  const std::string extension = choice.what == ExportWhat::kAllObjects ? "" : choice.format.extension;
  return free_path(folder / (stem + "_" + name + extension), extension).string();
}

std::filesystem::path target_of(const ExportChoice& choice) {
  const bool folder = choice.what == ExportWhat::kAllObjects;
  if (folder || choice.path.empty() || choice.path.ends_with(choice.format.extension)) return choice.path;
  return choice.path + choice.format.extension;
}

std::string amount_text(const ExportChoice& choice, std::size_t gaussians, const FormatPlan& plan) {
  return fmt::format("{} Gaussians, {}{}{}", grouped(gaussians), plan.about ? "about " : "",
                     human_bytes(plan.bytes), fills_hole(choice) ? ", and those that fill the hole" : "");
}

std::string loss_text(const ExportChoice& choice, const FormatPlan& plan) {
  if (!plan.lost.empty()) return "Lost: " + plan.lost;
  return fills_hole(choice) ? "Nothing is lost; what fills the hole is invented." : "Nothing is lost.";
}

bool names_written_format(std::string_view path) {
  const SceneFormat* named = find_format(std::filesystem::path(path));
  return named && named->write && path.ends_with(named->extension);
}

void follow_typed_name(ExportChoice& choice) {
  const SceneFormat* named = choice.what == ExportWhat::kAllObjects ? nullptr : find_format(choice.path);
  if (named && named->write && choice.path.ends_with(named->extension)) choice.format = *named;
}

}  // namespace splatcut
