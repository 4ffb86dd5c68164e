// Finished cells, one JSON object a line, on disk at once: a study that was stopped goes on where it was.
#pragma once

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/atomic_file.h"

namespace splatcut {

class StudyStore {
 public:
  // Reads what is there; a last line that was cut off is dropped. program: a name of this build; what another
  // one measured stays in the file and does not count. Throws Error where the file cannot be read or added
  // to, or another process does so.
  StudyStore(const std::filesystem::path& file, std::string program);
  StudyStore(const StudyStore&) = delete;
  StudyStore& operator=(const StudyStore&) = delete;
  ~StudyStore();

  bool holds(const std::string& key) const { return keys_.contains(key); }
  // Written to the disk before it returns. Throws Error where that fails.
  void add(const std::string& key, nlohmann::json result);
  const std::vector<nlohmann::json>& results() const {
    return results_;
  }                                                     // in the order in which they were finished
  std::size_t of_others() const { return of_others_; }  // measurements of other programs in the file

 private:
  std::filesystem::path path_;
  std::string program_;
  HeldFile lock_;  // two studies in one folder would measure all twice
  std::size_t of_others_ = 0;
  std::FILE* file_ = nullptr;
  std::vector<nlohmann::json> results_;
  std::set<std::string> keys_;
};

}  // namespace splatcut
