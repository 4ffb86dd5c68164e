#include "app/console/run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>

namespace splatcut {

namespace {

std::vector<char*> pointers_to(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

// A process group, empty but for its leader, which ends all of it once this thread has ended, however it did.
class Group {
 public:
  Group() {
    const pid_t parent = ::getpid();
    leader_ = ::fork();
    if (leader_ == 0) watch(parent);
    if (leader_ > 0) ::setpgid(leader_, leader_);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() {
    if (leader_ < 0) return;
    ::kill(leader_, SIGKILL);
    ::waitpid(leader_, nullptr, 0);
  }

  pid_t id() const { return leader_; }  // -1 where there is none
  void send(int signal) const { ::kill(-leader_, signal); }

 private:
  // Only calls that are allowed between fork and exec. It hears of nothing but its parent's end.
  [[noreturn]] static void watch(pid_t parent) {
    constexpr int kParentEnded = SIGUSR1;
    sigset_t all, awaited;
    ::sigfillset(&all);
    ::sigprocmask(SIG_SETMASK, &all, nullptr);
    ::sigemptyset(&awaited);
    ::sigaddset(&awaited, kParentEnded);
    ::setpgid(0, 0);
    ::close_range(STDERR_FILENO + 1, ~0U, 0);  // locks of the parent's, too
    ::prctl(PR_SET_PDEATHSIG, kParentEnded);
    int received = 0;
    if (::getppid() == parent) ::sigwait(&awaited, &received);
    ::kill(-::getpid(), SIGKILL);
    ::_exit(0);
  }

  pid_t leader_ = -1;
};

}  // namespace

int start_program(const std::vector<std::string>& words, int output, std::optional<pid_t> group, pid_t* child,
                  std::optional<int> input) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&files);
  if (input)
    ::posix_spawn_file_actions_adddup2(&files, *input, STDIN_FILENO);
  else
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  ::posix_spawnattr_init(&attributes);
  if (group) ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, group.value_or(0));
  const std::vector<char*> arguments = pointers_to(words);
  const int error = ::posix_spawnp(child, arguments.front(), &files, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return error;
}

ProgramEnd run_program(const std::vector<std::string>& words, const Job& job) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kLook = std::chrono::milliseconds(20), kGrace = std::chrono::milliseconds(2000);
  const Group group;
  pid_t child = 0;
  ProgramEnd end;
  end.start_error = group.id() < 0 ? errno : start_program(words, STDERR_FILENO, group.id(), &child);
  if (end.start_error != 0) return end;
  int status = 0;
  Clock::time_point asked_to_end{};
  for (pid_t ended = 0; ended != child;) {
    ended = ::waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) return end;
    if (ended == child) break;
    if (job.cancelled() && asked_to_end == Clock::time_point{}) {
      group.send(SIGTERM);
      asked_to_end = Clock::now();
    } else if (job.cancelled() && Clock::now() - asked_to_end > kGrace) {
      group.send(SIGKILL);
    }
    std::this_thread::sleep_for(kLook);
  }
  if (job.cancelled()) group.send(SIGKILL);  // what it started and left
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

bool on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace splatcut
