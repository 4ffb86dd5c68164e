// An output folder that is replaced as a whole or not at all, by one process at a time.
//
// The files are written into OUT.splatcut.new. commit() links OUT's other files into that folder, exchanges
// it with OUT in one step of the file system, and brings OUT's other folders back; so in each subfolder that
// both have. OUT.splatcut.part is held meanwhile: a second process is refused, and what a killed one left is
// set right by the next. Where OUT cannot be exchanged (the current folder, a mount point, a file system that
// does not know how), the files are renamed one by one: then alone a kill in these moments leaves old beside
// new.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/atomic_file.h"

namespace splatcut {

// Both throw Error where something is there already and overwriting was not asked for; the second also for
// what cannot be written as a file. A pipe or a device is written to, not replaced.
inline constexpr const char* kOverwriteOption = "Give --overwrite to replace it, or another -o";
void refuse_existing(const std::filesystem::path& path, bool overwrite,
                     const char* remedy = kOverwriteOption);
void check_output_file(const std::filesystem::path& path, bool overwrite,
                       const char* remedy = kOverwriteOption);

class OutputFolder {
 public:
  // Throws Error where the folder is there and overwriting was not asked for, where another process writes
  // it, or where it cannot be made.
  OutputFolder(const std::filesystem::path& path, bool overwrite);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();  // without commit() all is as before

  std::filesystem::path file(const std::string& name) const { return fresh_ / name; }
  std::vector<std::string> names() const;  // of the files so far, in order

  // Throws Error where it cannot be done: a name that is a folder in OUT, for one. Nothing is lost then.
  void commit();

 private:
  void set_right();
  void remove_unfinished();
  std::uint64_t number_in_lock() const;

  std::filesystem::path path_, target_;  // as given; absolute, behind all links
  std::filesystem::path fresh_;
  std::vector<std::filesystem::path> made_;  // folders above it, the nearest first
  bool overwrite_ = false, exchangeable_ = false;
  std::optional<HeldFile> lock_;  // holds the inode number of the folder that is being filled
};

}  // namespace splatcut
