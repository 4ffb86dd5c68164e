#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <climits>
#include <cstring>
#include <thread>
#include <utility>

#include "core/error.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPart = ".splatcut.part";

Error cannot_be_written(const fs::path& path, int error) {
  const bool full = error == ENOSPC || error == EDQUOT;
  if (error == ENAMETOOLONG)
    return {path.string(), "cannot be written: its name is too long",
            fmt::format("Choose one of at most {} bytes: a letter beyond a to z has two to four",
                        NAME_MAX - std::strlen(kPart))};
  return {path.string(), fmt::format("cannot be written ({})", std::strerror(error)),
          full ? "Make room there, or choose another place" : "Choose another place"};
}

// No link is followed: in a folder that others may write to, it might lead anywhere.
int open_part(const fs::path& file, const fs::path& meant) {
  constexpr int kMode = 0666;  // less what the user's mask takes
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, kMode);
  if (descriptor < 0) throw cannot_be_written(meant, errno);
  return descriptor;
}

// False where the file was renamed or removed by who held it before.
bool is_still_at(int descriptor, const fs::path& file) {
  struct stat held {};
  struct stat there {};
  return ::fstat(descriptor, &held) == 0 && ::lstat(file.c_str(), &there) == 0 &&
         held.st_ino == there.st_ino && held.st_dev == there.st_dev && S_ISREG(held.st_mode);
}

// A pipe is not waited for: nobody may ever come to read.
int open_stream(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (descriptor < 0 && errno == ENXIO) throw Error(path.string(), "is a pipe that no program reads from");
  if (descriptor < 0) throw cannot_be_written(path, errno);
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return descriptor;
}

}  // namespace

HeldFile::HeldFile(fs::path file, const fs::path& meant) : file_(std::move(file)) {
  using Clock = std::chrono::steady_clock;
  constexpr int kTries = 100;  // each is lost to a process that ended in between
  constexpr std::chrono::milliseconds kEnding{1000}, kLook{10};  // how long a killed program may hold it
  const Clock::time_point patience_ends = Clock::now() + kEnding;
  for (int i = 0; i < kTries;) {
    descriptor_ = open_part(file_, meant);
    const bool held_by_another = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!held_by_another && is_still_at(descriptor_, file_)) return;  // file systems without locks go on, too
    ::close(std::exchange(descriptor_, -1));
    if (held_by_another && Clock::now() > patience_ends)
      throw Error(meant.string(), "is being written by another program",
                  "Wait until that has ended, or choose another place");
    if (held_by_another)
      std::this_thread::sleep_for(kLook);
    else
      ++i;
  }
  throw Error(meant.string(), fmt::format("cannot be written: {} is in the way", file_.string()));
}

HeldFile::~HeldFile() {
  if (is_still_at(descriptor_, file_)) ::unlink(file_.c_str());
  ::close(descriptor_);
}

bool is_stream(const fs::path& path) {
  std::error_code failure;
  switch (fs::status(path, failure).type()) {
    case fs::file_type::character:
    case fs::file_type::fifo:
      return true;
    case fs::file_type::directory:
      throw Error(path.string(), "is a folder, where a file is to be written");
    case fs::file_type::block:
      throw Error(path.string(), "is a disk, where a file is to be written");
    case fs::file_type::socket:
      throw Error(path.string(), "is a socket, where a file is to be written");
    default:
      return false;
  }
}

fs::path behind_links(fs::path path) {
  constexpr int kMostLinks = 40;  // as the kernel follows
  std::error_code failure;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, failure); ++i)
    path = path.parent_path() / fs::read_symlink(path, failure);
  return path;
}

void make_like(const fs::path& model, const fs::path& path) {
  struct stat status {};
  constexpr mode_t kPermissions = 07777, kOfGroup = 070;
  if (::stat(model.c_str(), &status) != 0) return;
  mode_t mode = status.st_mode & kPermissions;
  if (::chown(path.c_str(), status.st_uid, status.st_gid) != 0 &&           // root alone may
      ::chown(path.c_str(), static_cast<uid_t>(-1), status.st_gid) != 0) {  // who belongs to the group may
    struct stat now {};
    if (::stat(path.c_str(), &now) == 0 && now.st_gid != status.st_gid) mode &= ~kOfGroup;  // another group
  }
  ::chmod(path.c_str(), mode);
}

void wait_for_disk(const fs::path& path, const fs::path& meant) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) throw cannot_be_written(meant, errno);
  const int failure = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (failure != 0 && failure != EINVAL && failure != ENOSYS) throw cannot_be_written(meant, failure);
}

AtomicFile::AtomicFile(fs::path path, PowerCut power_cut) : path_(std::move(path)), power_cut_(power_cut) {
  int descriptor = -1;
  if (is_stream(path_)) {
    descriptor = open_stream(path_);
  } else {
    target_ = behind_links(path_);
    part_.emplace(fs::path(target_) += kPart, path_);
    descriptor = ::fcntl(part_->descriptor(), F_DUPFD_CLOEXEC, 0);  // the lock outlives the stream
    if (descriptor >= 0 && ::ftruncate(descriptor, 0) != 0) throw cannot_be_written(path_, errno);
    // Until it is like what it takes the place of, which may be nobody else's.
    constexpr mode_t kOwner = 0600;
    if (std::error_code failure; fs::exists(target_, failure)) ::fchmod(descriptor, kOwner);
  }
  stream_ = ::fdopen(descriptor, "wb");
  if (!stream_) throw cannot_be_written(path_, errno);
}

AtomicFile::~AtomicFile() {
  if (stream_) std::fclose(stream_);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size())
    throw cannot_be_written(path_, errno);
  bytes_written_ += bytes.size();
}

void AtomicFile::commit() {
  if (std::ferror(stream_) != 0) throw cannot_be_written(path_, EIO);  // whose number is long gone
  if (std::fflush(stream_) != 0) throw cannot_be_written(path_, errno);
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) throw cannot_be_written(path_, errno);
  std::error_code failure;
  if (part_ && power_cut_ == PowerCut::kLeavesOldOrNew && fs::exists(target_, failure))
    wait_for_disk(part_->path(), path_);
  if (part_) make_like(target_, part_->path());
  if (part_) fs::rename(part_->path(), target_, failure);
  if (failure) throw cannot_be_written(path_, failure.value());
}

void write_text_file(const fs::path& path, std::string_view text, PowerCut power_cut) {
  AtomicFile file(path, power_cut);
  file.write(std::as_bytes(std::span(text.data(), text.size())));
  file.commit();
}

}  // namespace splatcut
