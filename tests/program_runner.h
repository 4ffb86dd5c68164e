// Runs the built programs in a folder of its own and looks at what they leave there. eval, click-chart, study
// and make-scene are commands of splatcut-lab, all others of splatcut.
#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "places.h"

namespace splatcut::testing {

struct Result {
  int code = -1;  // exit code, -1 where a signal ended the program
  int signal = 0;
  std::string out, err;
  double peak_mb = 0;  // of memory
};

class Workplace {
 public:
  Workplace() {
    std::string name = (std::filesystem::temp_directory_path() / "splatcut_cli_test_XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()));
    folder_ = name;
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  ~Workplace() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  void make_folder(const std::string& name) const { std::filesystem::create_directories(folder_ / name); }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    REQUIRE_MESSAGE(in, name);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  std::set<std::string> files_in(const std::string& name) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / name))
      names.insert(entry.path().filename());
    return names;
  }
  // Temporary files and folders that nobody renamed or removed.
  std::set<std::string> leftovers() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      for (const char* ending : {".splatcut.part", ".splatcut.new"})
        if (entry.path().string().ends_with(ending)) names.insert(entry.path().filename());
    return names;
  }

  // arguments: separated by blanks, no quoting; whole_arguments may hold blanks. The program's current folder
  // is this one.
  Result run(const std::string& arguments) const { return finish(start(words_of(arguments))); }
  Result run(const std::string& arguments, const std::vector<std::string>& whole_arguments) const {
    return finish(start(words_of(arguments, whole_arguments)));
  }

  Result run_program(const std::string& program, const std::string& arguments) const {
    std::vector<std::string> words = words_of(arguments);
    words.front() = program;
    return finish(start(words));
  }

  // With variables NAME=VALUE added to its environment.
  Result run_with(const std::vector<std::string>& variables, const std::string& arguments) const {
    return finish(start(words_of(arguments), variables));
  }

  Result run_interrupted(const std::string& arguments, int after_ms, int signal = SIGINT) const {
    const pid_t child = begin(arguments);
    std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
    ::kill(child, signal);
    return finish(child);
  }

  // Runs it beside the test; finish() waits for its end.
  pid_t begin(const std::string& arguments, const std::vector<std::string>& whole_arguments = {}) const {
    return start(words_of(arguments, whole_arguments));
  }
  // False where that takes half a minute.
  bool appears(const std::string& file) const {
    for (int tenths = 0; tenths < 300 && !exists(file); ++tenths)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return exists(file);
  }
  Result finish(pid_t child) const {
    int status = 0;
    rusage usage{};
    REQUIRE(::wait4(child, &status, 0, &usage) == child);
    Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                  text("stdout.txt"), text("stderr.txt"), static_cast<double>(usage.ru_maxrss) / 1024};
    return result;
  }

 private:
  static std::vector<std::string> words_of(const std::string& arguments,
                                           const std::vector<std::string>& whole_arguments = {}) {
    std::istringstream in(arguments);
    std::vector<std::string> words = {splatcut_program()};
    for (std::string word; in >> word;) words.push_back(word);
    for (const char* command : {"eval", "click-chart", "study", "make-scene"})
      if (words.size() > 1 && words[1] == command) words.front() = lab_program();
    words.insert(words.end(), whole_arguments.begin(), whole_arguments.end());
    return words;
  }

  pid_t start(std::vector<std::string> words, std::vector<std::string> variables = {}) const {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    variables.push_back("XDG_CACHE_HOME=" + (folder_ / "cache").string());  // not the user's own
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    for (char** variable = environ; *variable; ++variable)
      if (!std::string_view(*variable).starts_with("XDG_CACHE_HOME=")) environment.push_back(*variable);
    environment.push_back(nullptr);
    const std::string out = (folder_ / "stdout.txt").string(), err = (folder_ / "stderr.txt").string();
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addchdir_np(&actions, folder_.c_str());
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC, kMode = 0600;
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kFlags, kMode);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), kFlags, kMode);
    pid_t child = 0;
    const int failed =
        ::posix_spawn(&child, words.front().c_str(), &actions, nullptr, argv.data(), environment.data());
    ::posix_spawn_file_actions_destroy(&actions);
    REQUIRE(failed == 0);
    return child;
  }

  std::filesystem::path folder_;
};

}  // namespace splatcut::testing
