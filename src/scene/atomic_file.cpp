#include "scene/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "scene/error.h"

namespace splatcut {

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  temporary_ = path_;
  temporary_ += fmt::format(".{}.part", ::getpid());
  stream_ = std::fopen(temporary_.c_str(), "wb");
  if (!stream_) throw Error(path_.string(), fmt::format("cannot be written ({})", std::strerror(errno)));
}

AtomicFile::~AtomicFile() {
  if (!stream_) return;
  std::fclose(stream_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size())
    throw Error(path_.string(), fmt::format("writing failed ({})", std::strerror(errno)),
                "Is the disk full?");
}

void AtomicFile::commit() {
  const bool flushed = std::fflush(stream_) == 0 && std::ferror(stream_) == 0;
  const bool closed = std::fclose(std::exchange(stream_, nullptr)) == 0;
  std::error_code failure;
  if (flushed && closed) std::filesystem::rename(temporary_, path_, failure);
  if (flushed && closed && !failure) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  throw Error(path_.string(), failure ? failure.message() : "writing failed", "Is the disk full?");
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text.data(), text.size())));
  file.commit();
}

}  // namespace splatcut
