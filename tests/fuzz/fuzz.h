// What every fuzzer has: whatever the bytes are, the reader reads them or throws Error. Anything else that is
// thrown, what a sanitizer says and what takes long is a finding. SPLATCUT_FUZZ_READER names the reader.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

namespace splatcut {

// A folder in memory, of this process; its files are written anew for each input.
class InputFolder {
 public:
  InputFolder() {
    std::string name = "/dev/shm/splatcut_fuzz_XXXXXX";
    if (!::mkdtemp(name.data())) std::abort();
    folder_ = name;
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;
  ~InputFolder() { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const char* name, std::string_view bytes) const {
    const std::filesystem::path file = folder_ / name;
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0 || ::write(descriptor, bytes.data(), bytes.size()) != std::ssize(bytes)) std::abort();
    ::close(descriptor);
    return file;
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

inline const InputFolder& place() {
  static const InputFolder made;
  return made;
}

}  // namespace splatcut

#ifdef SPLATCUT_FUZZ_READER
#define SPLATCUT_FUZZ_ENTRY                                                           \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    try {                                                                             \
      splatcut::SPLATCUT_FUZZ_READER({reinterpret_cast<const char*>(data), size});    \
    } catch (const splatcut::Error&) {                                                \
    }                                                                                 \
    return 0;                                                                         \
  }
#else  // corpus_test.cpp calls all of them
#define SPLATCUT_FUZZ_ENTRY
#endif
