// Files read whole: as memory, or as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace splatcut {

class MappedFile {
 public:
  // Throws Error for what is missing, unreadable, no regular file (a directory) or empty.
  explicit MappedFile(std::filesystem::path path);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(data_), size_}; }
  std::string_view text() const { return {static_cast<const char*>(data_), size_}; }
  const std::filesystem::path& path() const { return path_; }
  std::int64_t modified_ns() const { return modified_ns_; }

 private:
  std::filesystem::path path_;
  void* data_ = nullptr;
  std::size_t size_ = 0;
  std::int64_t modified_ns_ = 0;
};

inline bool begins_with(const MappedFile& file, std::string_view mark) {
  return file.text().starts_with(mark);
}

// Whether an object of JSON may begin there: its first character that is no blank is a brace.
inline bool begins_as_json(const MappedFile& file) {
  const std::size_t first = file.text().find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && file.text()[first] == '{';
}

// The bytes of a file that the person named: a pipe will do. Throws Error for a folder, for more than 1 GB,
// and for what cannot be read.
std::string text_of_file(const std::filesystem::path& path);

}  // namespace splatcut
