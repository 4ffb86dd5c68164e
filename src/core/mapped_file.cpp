#include "core/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace splatcut {

namespace {

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

MappedFile::MappedFile(std::filesystem::path path) : path_(std::move(path)) {
  // O_NONBLOCK: a pipe without a writer is refused below instead of waited for.
  const Descriptor file{::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status {};
  if (file.fd < 0 || ::fstat(file.fd, &status) != 0)
    throw Error(path_.string(), fmt::format("cannot be opened ({})", std::strerror(errno)));
  if (S_ISDIR(status.st_mode)) throw Error(path_.string(), "is a directory, a file is wanted");
  if (!S_ISREG(status.st_mode)) throw Error(path_.string(), "is not a regular file");
  if (status.st_size == 0) throw Error(path_.string(), "the file is empty (0 bytes)");
  size_ = static_cast<std::size_t>(status.st_size);
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  modified_ns_ = static_cast<std::int64_t>(status.st_mtim.tv_sec) * kNsPerSecond + status.st_mtim.tv_nsec;
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.fd, 0);
  if (data == MAP_FAILED)
    throw Error(path_.string(), fmt::format("cannot be mapped into memory ({})", std::strerror(errno)));
  data_ = data;
  ::madvise(data_, size_, MADV_WILLNEED);
}

MappedFile::~MappedFile() {
  ::munmap(data_, size_);
}

std::string text_of_file(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30, kPiece = 1 << 16;
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  std::string text;
  std::array<char, kPiece> piece;
  for (ssize_t got = 1; got != 0;) {
    got = file.fd < 0 ? -1 : ::read(file.fd, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(path.string(), fmt::format("cannot be opened ({})", std::strerror(errno)));
    text.append(piece.data(), static_cast<std::size_t>(got));
    if (text.size() > kMostBytes) throw Error(path.string(), "holds more than 1 GB");
  }
  return text;
}

}  // namespace splatcut
