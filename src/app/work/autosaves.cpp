#include "app/work/autosaves.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "app/work/work_file.h"
#include "app/work/work_picture.h"

namespace splatcut {

namespace {

constexpr std::string_view kFirst = "autosave";

std::filesystem::path lock_beside(const std::filesystem::path& file) {
  std::string path = file.string();
  return path.replace(path.size() - kWorkEnding.size(), std::string::npos, ".lock");
}

// -1 where another program holds it. Children do not inherit it.
int lock_of(const std::filesystem::path& file) {
  const int descriptor = ::open(lock_beside(file).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor < 0) return -1;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

// True if the program whose number stands in the lock has been killed: it holds the lock until its memory is
// given back, which can take seconds, and writes nothing any more.
bool holder_ends(const std::filesystem::path& file) {
  constexpr unsigned long kExiting = 4;  // PF_EXITING in the kernel's sched.h
  int number = 0;
  std::ifstream(lock_beside(file)) >> number;
  std::string line;
  if (number <= 0 || !std::getline(std::ifstream(fmt::format("/proc/{}/stat", number)), line)) return false;
  std::istringstream fields(line.substr(std::min(line.rfind(')') + 2, line.size())));
  std::string state, skipped;
  fields >> state;
  for (int i = 0; i < 5; ++i) fields >> skipped;
  unsigned long flags = 0;
  fields >> flags;
  return state == "Z" || (flags & kExiting) != 0;
}

}  // namespace

Autosaves::Autosaves(const std::filesystem::path& folder) : folder_(folder) {
  if (folder.empty()) return;
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (!trouble) hold_left_behind(folder);
  if (!trouble) hold_own(folder);
}

Autosaves::~Autosaves() {
  left_.push_back(own_);
  for (const Held& held : left_)
    if (held.lock >= 0) ::close(held.lock);
}

void Autosaves::hold_left_behind(const std::filesystem::path& folder) {
  std::error_code trouble;
  for (auto entry = std::filesystem::directory_iterator(folder, trouble);
       !trouble && entry != std::filesystem::directory_iterator(); entry.increment(trouble)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(kFirst) || !name.ends_with(kWorkEnding)) continue;
    std::error_code unreadable;
    const auto written = entry->last_write_time(unreadable);
    const auto known = std::ranges::find(left_, entry->path(), &Held::file);
    if (unreadable || (known != left_.end() && known->lock >= 0)) continue;
    const int lock = lock_of(entry->path());
    if (known != left_.end())
      known->lock = lock;
    else if (lock >= 0 || holder_ends(entry->path()))
      left_.push_back({entry->path(), lock, written});
  }
  std::ranges::sort(left_, {}, &Held::written);
}

void Autosaves::hold_own(const std::filesystem::path& folder) {
  constexpr int kMostFiles = 10'000;  // of programs that run, and of work that was left
  for (int number = 1; number <= kMostFiles && own_.lock < 0; ++number) {
    const std::string middle = number == 1 ? "" : fmt::format(".{}", number);
    const std::filesystem::path file = folder / fmt::format("{}{}{}", kFirst, middle, kWorkEnding);
    std::error_code unreadable;
    if (std::filesystem::exists(file, unreadable) || unreadable) continue;
    const int lock = lock_of(file);
    if (lock < 0) continue;
    own_ = {file, lock, {}};
    std::ofstream(lock_beside(file)) << ::getpid() << '\n';
  }
}

std::vector<std::filesystem::path> Autosaves::left_behind() const {
  std::vector<std::filesystem::path> files;
  for (const Held& held : left_) files.insert(files.begin(), held.file);
  return files;
}

void Autosaves::leave_own() {
  if (own_.lock < 0) return;
  own_.written = std::filesystem::file_time_type::clock::now();
  left_.push_back(std::exchange(own_, {}));
  hold_own(folder_);
}

void Autosaves::remove(const std::filesystem::path& file) {
  const auto held = std::ranges::find(left_, file, &Held::file);
  if (held == left_.end()) return;
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  std::filesystem::remove(picture_of_work(file), ignored);
  if (held->lock >= 0) ::close(held->lock);
  left_.erase(held);
}

}  // namespace splatcut
