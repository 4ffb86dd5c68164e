// Choosing a file or folder inside the window, for desktops without a dialog of their own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace splatcut {

enum class FilePurpose { kOpen, kAdd, kSaveWork, kSnapshot, kTurntable, kExport, kFill };

// What a dialog for that is called and lists.
struct FileKind {
  const char *title, *button, *extension;  // extension: added where none is given
  std::vector<std::string> shown;
};
FileKind kind_of(FilePurpose purpose);

struct BrowserEntry {
  std::string name;
  bool folder = false;
  std::uint64_t bytes = 0;
};

struct FileBrowser {
  bool open = false;
  bool saving = false;                  // a name can be typed
  bool name_first = false;              // the name field has the focus
  bool path_first = false;              // the field of the folder has it
  std::string title, name;              // name: what is chosen or typed
  std::vector<std::string> extensions;  // shown files; empty: all
  std::filesystem::path folder;
  std::string typed_folder;           // in the field of the folder: a path, or the beginning of a name here
  bool typed = false;                 // it was typed since the list was moved in, and is what Enter means
  std::vector<BrowserEntry> entries;  // of the folder, folders first
  std::string trouble;                // why the folder cannot be read

  // The entry under the keyboard cursor; -1: none.
  int cursor = -1;
  std::string typed_start;  // letters typed in quick succession
  double typed_s = -1e9;    // when the last of them was

  void enter(const std::filesystem::path& where);  // reads it
  void go(int entry);                              // the nearest there is; a file is chosen by it
  // To the first entry that begins with the name in typed_folder, in the folder of a whole path; to none
  // where it is a path from here.
  void follow_typed();
  std::filesystem::path typed_path() const;  // typed_folder as a path: from the folder, or from home after ~
  // To the first entry that begins with the letters typed within a second, whatever their case. now_s: any
  // clock.
  void type(const std::string& letter, double now_s);
};

// What folders are called in a list: by their names, those of one name with that of the folder that they are
// in.
std::vector<std::string> names_of_folders(const std::vector<std::filesystem::path>& folders);

}  // namespace splatcut
