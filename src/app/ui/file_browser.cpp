#include "app/ui/file_browser.h"

#include <algorithm>

namespace splatcut {

void FileBrowser::enter(const std::filesystem::path& where) {
  namespace fs = std::filesystem;
  std::error_code trouble_code;
  folder = fs::weakly_canonical(where, trouble_code);
  if (trouble_code || folder.empty()) folder = where;
  typed_folder = folder.string();
  entries.clear();
  trouble.clear();
  fs::directory_iterator all(folder, fs::directory_options::skip_permission_denied, trouble_code);
  if (trouble_code) {
    trouble = trouble_code.message();
    return;
  }
  for (const fs::directory_entry& entry : all) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with('.')) continue;
    std::error_code ignored;
    const bool is_folder = entry.is_directory(ignored);
    const bool wanted = extensions.empty() || std::ranges::any_of(extensions, [&](const std::string& e) {
                          return file.ends_with(e);
                        });
    if (is_folder || wanted) entries.push_back({file, is_folder, is_folder ? 0 : entry.file_size(ignored)});
  }
  std::ranges::sort(entries, [](const BrowserEntry& a, const BrowserEntry& b) {
    return a.folder != b.folder ? a.folder : a.name < b.name;
  });
}

}  // namespace splatcut
