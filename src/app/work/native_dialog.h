// The desktop's own file dialog: zenity or kdialog, run as a program. The window goes on meanwhile.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace splatcut {

struct FileQuestion {
  std::string title;
  bool saving = false;
  std::filesystem::path start;          // folder, with the proposed name where saving
  std::vector<std::string> extensions;  // files shown; empty: all
};

class NativeDialog {
 public:
  enum class State { kClosed, kOpen, kChosen, kCancelled, kFailed };

  NativeDialog() = default;
  ~NativeDialog();
  NativeDialog(const NativeDialog&) = delete;
  NativeDialog& operator=(const NativeDialog&) = delete;

  // False where neither program is on the PATH or it cannot be started. One that is open closes first.
  bool ask(const FileQuestion& question);
  // Its state now; each end is reported once. Never waits.
  State poll();
  const std::filesystem::path& path() const { return path_; }  // after kChosen

 private:
  void close();

  pid_t child_ = -1;
  int output_ = -1;  // of the child
  std::string text_;
  std::filesystem::path path_;
};

// The program and its arguments; empty where there is none. For tests, too.
std::vector<std::string> native_dialog_command(const FileQuestion& question);

}  // namespace splatcut
