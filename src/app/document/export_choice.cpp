#include "app/document/export_choice.h"

#include "app/document/words.h"

namespace splatcut {

std::string proposed_path(const ExportChoice& choice, const std::filesystem::path& scene,
                          const ObjectItem* object) {
  const std::filesystem::path folder = choice.path.empty() ? std::filesystem::absolute(scene).parent_path()
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

void follow_typed_name(ExportChoice& choice) {
  const SceneFormat* named = choice.what == ExportWhat::kAllObjects ? nullptr : find_format(choice.path);
  if (named && named->write && choice.path.ends_with(named->extension)) choice.format = *named;
}

}  // namespace splatcut
