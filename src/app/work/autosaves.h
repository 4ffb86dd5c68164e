// Autosaves in the state folder: one per running program, and those that programs left which no longer run.
//
// A program holds the lock beside its file for as long as it lives; a file whose lock is free was left by a
// crash. Errors: none; what cannot be read or locked is neither offered nor written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace splatcut {

class Autosaves {
 public:
  // folder: empty: no autosaves.
  explicit Autosaves(const std::filesystem::path& folder);
  ~Autosaves();
  Autosaves(const Autosaves&) = delete;
  Autosaves& operator=(const Autosaves&) = delete;

  const std::filesystem::path& own() const { return own_.file; }  // empty: none is to be written
  // Left by others, the newest; empty: none. No other program offers it meanwhile.
  std::filesystem::path left_behind() const;
  // Also what a program left that had not quite ended before.
  void look_again() {
    if (!folder_.empty()) hold_left_behind(folder_);
  }
  void remove(const std::filesystem::path& file);  // one that was left behind

 private:
  struct Held {
    std::filesystem::path file;
    int lock = -1;  // descriptor
    std::filesystem::file_time_type written;
  };
  void hold_left_behind(const std::filesystem::path& folder);
  void hold_own(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  Held own_;
  std::vector<Held> left_;  // the newest last
};

}  // namespace splatcut
