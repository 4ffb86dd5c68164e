// An output folder that appears whole or not at all: files are written beside its place and the folder
// renamed when all are there.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "scene/error.h"

namespace splatcut {

// Throws Error where something is there already and overwriting was not asked for.
inline void refuse_existing(const std::filesystem::path& path, bool overwrite) {
  if (std::filesystem::exists(path) && !overwrite)
    throw Error(path.string(), "exists already", "Give --overwrite to replace it, or another -o");
}

class OutputFolder {
 public:
  OutputFolder(std::filesystem::path path, bool overwrite) : path_(std::move(path)) {
    if (path_.filename().empty()) path_ = path_.parent_path();
    refuse_existing(path_, overwrite);
    if (std::filesystem::exists(path_) && !std::filesystem::is_directory(path_))
      throw Error(path_.string(), "is a file, where a folder is to be written");
    building_ = path_;
    building_ += fmt::format(".{}.part", ::getpid());
    std::error_code failure;
    std::filesystem::create_directories(building_, failure);
    if (failure) throw Error(path_.string(), "cannot be created (" + failure.message() + ")");
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder() {
    std::error_code ignored;
    if (!building_.empty()) std::filesystem::remove_all(building_, ignored);
  }

  std::filesystem::path file(const std::string& name) const { return building_ / name; }

  // Files of ours replace those of an older run; anything else in an existing folder stays.
  void commit() {
    if (!std::filesystem::exists(path_)) {
      std::filesystem::rename(building_, path_);
    } else {
      for (const auto& entry : std::filesystem::directory_iterator(building_))
        std::filesystem::rename(entry.path(), path_ / entry.path().filename());
      std::filesystem::remove_all(building_);
    }
    building_.clear();
  }

 private:
  std::filesystem::path path_, building_;
};

}  // namespace splatcut
