#include "app/lab/study/study_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

StudyStore::StudyStore(const std::filesystem::path& file, std::string program)
    : path_(file),
      program_(std::move(program)),
      lock_(std::filesystem::path(file) += ".splatcut.part", file) {
  std::size_t whole = 0;  // bytes of complete lines
  if (std::ifstream in(file, std::ios::binary); in) {
    for (std::string line; std::getline(in, line) && !in.eof(); whole += line.size() + 1) {
      nlohmann::json result = nlohmann::json::parse(line, nullptr, false);
      if (result.is_discarded() || !result.contains("key"))
        throw Error(file.string(), "is not a list of measurements", "Take another -o");
      if (result.value("program", "") != program_) {
        ++of_others_;
        continue;
      }
      keys_.insert(result.at("key").get<std::string>());
      results_.push_back(std::move(result));
    }
    in.close();
    std::filesystem::resize_file(file, whole);
  }
  file_ = std::fopen(file.c_str(), "ab");
  if (!file_) throw Error(file.string(), std::string("cannot be written (") + std::strerror(errno) + ")");
}

StudyStore::~StudyStore() {
  std::fclose(file_);
}

void StudyStore::add(const std::string& key, nlohmann::json result) {
  result["key"] = key;
  result["program"] = program_;
  const std::string line = json_text(result) + "\n";
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size() || std::fflush(file_) != 0 ||
      ::fsync(::fileno(file_)) != 0)
    throw Error(path_.string(), std::string("cannot be written (") + std::strerror(errno) + ")",
                "Make room on the disk; what is finished is kept");
  keys_.insert(key);
  results_.push_back(std::move(result));
}

}  // namespace splatcut
