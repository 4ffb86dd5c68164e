// The one place that writes files: a file appears whole or not at all.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace splatcut {

// A file that one process at a time holds, removed by the destructor where it was not renamed. The lock ends
// with the process, however that ends: what is found without one was left behind and is anybody's.
class HeldFile {
 public:
  // Creates the file where it is missing; what it holds stays. Throws Error, naming `meant`, where another
  // process holds it for a second, or it cannot be written: the lock of a program that was killed ends only
  // once the system has taken its memory apart.
  HeldFile(std::filesystem::path file, const std::filesystem::path& meant);
  HeldFile(const HeldFile&) = delete;
  HeldFile& operator=(const HeldFile&) = delete;
  ~HeldFile();

  int descriptor() const { return descriptor_; }
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

// What a power cut may do to a file that takes the place of another: to wait for the disk takes a tenth of a
// second and more.
enum class PowerCut { kLeavesOldOrNew, kMayLeaveNone };

// Written beside its place as NAME.splatcut.part, renamed by commit(), removed where commit() is never
// reached; what a killed process left is written over. A symbolic link stays, what it points to is replaced
// and its permissions are kept.
// What takes bytes but is no file (a pipe, /dev/null) is written to as it is.
class AtomicFile {
 public:
  // Throws Error when it cannot be created.
  explicit AtomicFile(std::filesystem::path path, PowerCut power_cut = PowerCut::kLeavesOldOrNew);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  std::FILE* stream() { return stream_; }
  void write(std::span<const std::byte> bytes);                   // throws Error when the disk is full
  std::uint64_t bytes_written() const { return bytes_written_; }  // by write()
  void commit();                                                  // flushes, closes, renames; throws Error

 private:
  std::filesystem::path path_, target_;
  PowerCut power_cut_;
  std::optional<HeldFile> part_;  // none for a stream
  std::FILE* stream_ = nullptr;
  std::uint64_t bytes_written_ = 0;
};

// A pipe or a device of characters. Throws Error for what cannot be written as a file: a folder, a disk, a
// socket.
bool is_stream(const std::filesystem::path& path);

// Where the symbolic links lead that the path ends in; the last may point to nothing.
std::filesystem::path behind_links(std::filesystem::path path);

// Gives what is at `path` the permissions of the model, and its owner where one may; where there is none,
// nothing.
void make_like(const std::filesystem::path& model, const std::filesystem::path& path);

// Waits until all that was written to a file, or the names in a folder, are on the disk. Throws Error, naming
// `meant`, where they cannot be; file systems that know no such wait go on.
void wait_for_disk(const std::filesystem::path& path, const std::filesystem::path& meant);

// The whole text at once.
void write_text_file(const std::filesystem::path& path, std::string_view text,
                     PowerCut power_cut = PowerCut::kLeavesOldOrNew);

}  // namespace splatcut
