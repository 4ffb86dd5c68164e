#include "app/console/console.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <string>
#include <string_view>
#include <thread>

#include "core/atomic_file.h"
#include "core/error.h"

namespace splatcut {

namespace {

std::stop_source g_stop;
bool g_bar_drawn = false;

// Only async-signal-safe work is allowed in a handler: a thread turns the byte into a stop request.
int g_wake[2] = {-1, -1};

constexpr std::array kEndingSignals = {SIGINT, SIGTERM, SIGHUP};

void on_ending_signal(int) {
  const char byte = 1;
  [[maybe_unused]] const auto written = ::write(g_wake[1], &byte, 1);
  for (const int signal : kEndingSignals) std::signal(signal, SIG_DFL);
}

// A mapped file that another program cut short. Nothing can be cleaned here; the next run does it.
void on_bus_error(int) {
  constexpr std::string_view kSaid =
      "splatcut: a file became shorter while it was read. Run this again once it is whole.\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kSaid.data(), kSaid.size());
  ::_exit(1);
}

void watch_signals() {
  static const bool started = [] {
    if (::pipe2(g_wake, O_CLOEXEC) != 0) return false;
    std::thread([] {
      char byte;
      while (::read(g_wake[0], &byte, 1) != 1) continue;
      g_stop.request_stop();
    }).detach();
    std::signal(SIGBUS, on_bus_error);
    std::signal(SIGXFSZ, SIG_IGN);  // what is written past a limit fails, and is told
    for (const int signal : kEndingSignals) {
      const auto before = std::signal(signal, on_ending_signal);
      if (signal == SIGHUP && before == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
    }
    return true;
  }();
  (void)started;
}

void draw_bar(std::string_view stage, double fraction) {
  constexpr int kCells = 30;
  const int full = static_cast<int>(fraction * kCells + 0.5);
  to_stderr(
      fmt::format("\r{:<16} [{:#<{}}{:.<{}}] {:3.0f} %", stage, "", full, "", kCells - full, 100 * fraction));
  g_bar_drawn = true;
}

}  // namespace

Job console_job(bool quiet) {
  watch_signals();
  Job job;
  job.stop = g_stop.get_token();
  if (!quiet && ::isatty(STDERR_FILENO)) job.on_progress = draw_bar;
  return job;
}

void stop_if_cancelled(const Job& job, std::string_view command) {
  if (job.cancelled()) throw Error(command, "cancelled, nothing was written");
}

void warn(const std::string& sentence, bool quiet) {
  if (quiet || sentence.empty()) return;
  end_progress();
  to_stderr(fmt::format("splatcut: warning: {}.\n", sentence));
}

void end_progress() {
  if (g_bar_drawn) to_stderr(fmt::format("\r{:60}\r", ""));
  g_bar_drawn = false;
}

void say_written(const std::filesystem::path& file, const std::string& lines) {
  if (is_stream(file))
    to_stderr(lines);
  else
    fmt::print("{}", lines);
}

void to_stderr(const std::string& text) {
  std::fputs(text.c_str(), stderr);
}

}  // namespace splatcut
