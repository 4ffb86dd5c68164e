// Autosaves in the state folder: one file per running program, and the files that crashed programs left.
//
// A program holds the lock beside its file as long as it lives, so a file whose lock is free was left by a
// crash. So was one whose program is about to end. Errors: none are thrown; a file that cannot be read or
// locked is neither offered nor written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace splatcut {

class Autosaves {
 public:
  // folder: the state folder; empty: there are no autosaves.
  explicit Autosaves(const std::filesystem::path& folder);
  ~Autosaves();
  Autosaves(const Autosaves&) = delete;
  Autosaves& operator=(const Autosaves&) = delete;

  // File of this program; empty: this program must not write one.
  const std::filesystem::path& own() const { return own_.file; }
  // Files that crashed programs left, the newest first. This object holds their locks, so that no other
  // program offers them; of a program that is about to end it takes the lock when it looks again.
  std::vector<std::filesystem::path> left_behind() const;
  // Looks again for files that crashed programs left: one may have been about to end before.
  void look_again() {
    if (!folder_.empty()) hold_left_behind(folder_);
  }
  // The own file counts as left behind from now on, however many are, and another takes its place.
  void leave_own();
  // Deletes a file that was left behind, and its picture; ignores any other.
  void remove(const std::filesystem::path& file);

 private:
  struct Held {
    std::filesystem::path file;
    int lock = -1;  // descriptor of the locked file; -1: none, or its program is about to end
    std::filesystem::file_time_type written;
  };
  void hold_left_behind(const std::filesystem::path& folder);
  void hold_own(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  Held own_;
  std::vector<Held> left_;  // files that were left behind, the newest last
};

}  // namespace splatcut
