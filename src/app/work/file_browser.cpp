#include "app/work/file_browser.h"

#include <algorithm>
#include <cstdlib>

#include "app/work/work_file.h"
#include "core/lower_case.h"
#include "scene/formats/scene_formats.h"

namespace splatcut {

namespace {

std::vector<std::string> with(std::vector<std::string> extensions, const char* one_more) {
  extensions.emplace_back(one_more);
  return extensions;
}

}  // namespace

FileKind kind_of(FilePurpose purpose) {
  switch (purpose) {
    case FilePurpose::kOpen:
      return {"Open a scene or saved work", "Open", "",
              with(extensions_of(read_formats()), kWorkEnding.data())};
    case FilePurpose::kAdd:
      return {"Add a scene to this one", "Add", "", extensions_of(read_formats())};
    case FilePurpose::kSaveWork:
      return {"Save the work", "Save", kWorkEnding.data(), {std::string(kWorkEnding)}};
    case FilePurpose::kSnapshot:
      return {"Save a picture of the view, with transparency", "Save", ".png", {".png"}};
    case FilePurpose::kTurntable:
      return {"Where should the turntable go?", "Choose", "", {"/"}};
    case FilePurpose::kExport:
      return {"Where should it go?", "Choose", "", extensions_of(written_formats())};
    case FilePurpose::kFill:
      return {"Keep what fills the hole, as a file of the scene", "Keep", ".ply", {".ply"}};
  }
  return {};
}

void FileBrowser::enter(const std::filesystem::path& where) {
  namespace fs = std::filesystem;
  std::error_code trouble_code;
  folder = fs::weakly_canonical(where, trouble_code);
  if (trouble_code || folder.empty()) folder = where;
  typed_folder = folder.string();
  entries.clear();
  cursor = -1;
  typed = false;
  typed_start.clear();
  trouble.clear();
  fs::directory_iterator all(folder, fs::directory_options::skip_permission_denied, trouble_code);
  if (trouble_code) {
    trouble = trouble_code.message();
    return;
  }
  for (; all != fs::directory_iterator(); all.increment(trouble_code)) {
    const fs::directory_entry& entry = *all;
    const std::string file = entry.path().filename().string();
    if (file.starts_with('.')) continue;
    std::error_code ignored;
    const bool is_folder = entry.is_directory(ignored);
    const bool wanted = extensions.empty() || std::ranges::any_of(extensions, [&](const std::string& e) {
                          return file.ends_with(e);
                        });
    if (is_folder || wanted) entries.push_back({file, is_folder, is_folder ? 0 : entry.file_size(ignored)});
  }
  if (trouble_code) trouble = trouble_code.message();
  std::ranges::sort(entries, [](const BrowserEntry& a, const BrowserEntry& b) {
    return a.folder != b.folder ? a.folder : a.name < b.name;
  });
}

void FileBrowser::go(int entry) {
  if (entries.empty()) return;
  cursor = std::clamp(entry, 0, static_cast<int>(entries.size()) - 1);
  const BrowserEntry& at = entries[static_cast<std::size_t>(cursor)];
  if (!at.folder)
    name = at.name;
  else if (!saving)
    name.clear();
}

std::filesystem::path FileBrowser::typed_path() const {
  const char* home = std::getenv("HOME");
  const bool from_home = home && (typed_folder == "~" || typed_folder.starts_with("~/"));
  return from_home ? std::filesystem::path(home + typed_folder.substr(1)) : folder / typed_folder;
}

void FileBrowser::follow_typed() {
  typed = true;
  std::string start = typed_folder;
  if (start.starts_with('/') ||
      start.starts_with("~/")) {  // its folder is listed, its last name sought there
    std::error_code ignored;
    const std::filesystem::path path = typed_path(),
                                where = std::filesystem::weakly_canonical(path.parent_path(), ignored);
    if (where != folder && std::filesystem::is_directory(where, ignored)) {
      enter(where);
      typed_folder = start;
      typed = true;
    }
    start = where == folder ? path.filename().string() : "";
  }
  cursor = -1;
  if (!saving) name.clear();
  if (start.empty() || start.starts_with('~') || start.find('/') != std::string::npos) return;
  const auto found = std::ranges::find_if(entries, [&](const BrowserEntry& e) {
    return (e.folder || !saving) &&
           lower_case(e.name).starts_with(lower_case(start));  // a file's name is given
  });
  if (found != entries.end()) go(static_cast<int>(found - entries.begin()));
}

void FileBrowser::type(const std::string& letter, double now_s) {
  constexpr double kNewWordSeconds = 1;
  if (now_s - typed_s > kNewWordSeconds) typed_start.clear();
  typed_s = now_s;
  typed_start += lower_case(letter);
  const auto found = std::ranges::find_if(
      entries, [&](const BrowserEntry& e) { return lower_case(e.name).starts_with(typed_start); });
  if (found != entries.end()) go(static_cast<int>(found - entries.begin()));
}

std::vector<std::string> names_of_folders(const std::vector<std::filesystem::path>& folders) {
  std::vector<std::string> names;
  for (const std::filesystem::path& folder : folders) {
    std::string name = folder.filename().string();
    std::filesystem::path within = folder.parent_path();
    const auto alike = [&](const std::filesystem::path& other) {
      return other != folder && other.filename() == folder.filename();
    };
    const auto beside = [&](const std::filesystem::path& other) {
      return alike(other) && other.parent_path().filename() == within.filename();
    };
    if (std::ranges::any_of(folders, beside))
      name += " (" + within.parent_path().filename().string() + "/" + within.filename().string() + ")";
    else if (std::ranges::any_of(folders, alike))
      name += " (" + within.filename().string() + ")";
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace splatcut
