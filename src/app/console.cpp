#include "app/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

namespace splatcut {

namespace {

std::stop_source g_stop;
bool g_bar_drawn = false;

// Only async-signal-safe work is allowed in a handler: a watcher thread turns the byte into a stop request.
int g_wake[2] = {-1, -1};

void on_interrupt(int) {
  const char byte = 1;
  [[maybe_unused]] const auto written = ::write(g_wake[1], &byte, 1);
  std::signal(SIGINT, SIG_DFL);
}

void watch_interrupts() {
  static const bool started = [] {
    if (::pipe(g_wake) != 0) return false;
    std::thread([] {
      char byte;
      if (::read(g_wake[0], &byte, 1) == 1) g_stop.request_stop();
    }).detach();
    std::signal(SIGINT, on_interrupt);
    return true;
  }();
  (void)started;
}

void draw_bar(std::string_view stage, double fraction) {
  constexpr int kCells = 30;
  const int full = static_cast<int>(fraction * kCells + 0.5);
  fmt::print(stderr, "\r{:<16} [{:#<{}}{:.<{}}] {:3.0f} %", stage, "", full, "", kCells - full,
             100 * fraction);
  std::fflush(stderr);
  g_bar_drawn = true;
}

}  // namespace

Job console_job(bool quiet) {
  watch_interrupts();
  Job job;
  job.stop = g_stop.get_token();
  if (!quiet && ::isatty(STDERR_FILENO)) job.on_progress = draw_bar;
  return job;
}

void warn(const std::string& sentence, bool quiet) {
  if (quiet || sentence.empty()) return;
  end_progress();
  fmt::print(stderr, "splatcut: warning: {}.\n", sentence);
}

void end_progress() {
  if (g_bar_drawn) fmt::print(stderr, "\r{:60}\r", "");
  g_bar_drawn = false;
}

}  // namespace splatcut
