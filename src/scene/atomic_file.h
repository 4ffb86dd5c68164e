// A file that appears whole or not at all: written beside its place under a temporary name, renamed by
// commit(); removed if commit() is never reached.
#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>

namespace splatcut {

class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);  // throws Error when it cannot be created
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  std::FILE* stream() { return stream_; }
  void write(std::span<const std::byte> bytes);  // throws Error when the disk is full
  void commit();                                 // flushes, closes, renames; throws Error

 private:
  std::filesystem::path path_, temporary_;
  std::FILE* stream_ = nullptr;
};

// The whole text at once.
void write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace splatcut
