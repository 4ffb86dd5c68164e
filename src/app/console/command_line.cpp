#include "app/console/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "app/console/console.h"
#include "app/console/version.h"
#include "core/error.h"
#include "core/spoken_list.h"

namespace splatcut {

namespace {

constexpr int kCouldNot = 1, kWrongUsage = 2, kMostThreads = 4096;

// An exception that cannot travel on: memory ran out while another was on its way, or within a library that
// lets none pass. Nothing can be cleaned then; the next run does it.
std::terminate_handler g_terminate_before = nullptr;
std::atomic<bool> g_memory_ran_out = false;

void on_no_memory() {
  g_memory_ran_out = true;
  throw std::bad_alloc();
}

[[noreturn]] void on_terminate() {
  constexpr std::string_view kSaid = "splatcut: There is not enough memory for this.\n";
  if (g_memory_ran_out) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kSaid.data(), kSaid.size());
    ::_exit(kCouldNot);
  }
  g_terminate_before();  // a defect: the C++ library says which exception it was
  std::abort();
}

// The library keeps the options that one excludes by their address: help would have another order in each
// run.
class OrderedHelp : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    constexpr std::string_view kLabel = " Excludes:";
    const std::size_t label = text.find(kLabel);
    if (label == text.npos) return text;
    std::vector<std::string> names = CLI::detail::split(text.substr(label + kLabel.size() + 1), ' ');
    std::ranges::sort(names);
    text.resize(label + kLabel.size());
    for (const std::string& name : names) text += " " + name;
    return text;
  }
};

// The library refuses some values, and commands others as bad input, once they know what these are for: all
// end the program alike.
bool refuses_value(const CLI::ParseError& error) {
  return dynamic_cast<const CLI::ValidationError*>(&error) ||
         dynamic_cast<const CLI::ConversionError*>(&error);
}

// A script's variable that is not set must not change what a command does: "" is a value of no option.
Error is_empty(const std::string& option) {
  return {option, "is empty", "Give a value, or leave it out: a variable of a script may be without one"};
}

void refuse_empty_values(CLI::App* command) {
  for (CLI::Option* option : command->get_options()) {
    const auto check = [name = option->get_name()](std::string& text) {
      if (text.empty()) throw is_empty(name);
      return std::string();
    };
    if (option->get_items_expected_min() > 0) option->transform(CLI::Validator(check, ""));  // before its own
  }
  for (CLI::App* below : command->get_subcommands({})) refuse_empty_values(below);
}

// "--name=" takes the next word for its value otherwise.
void refuse_empty_values(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "--") return;
    if (word.starts_with("--") && word.find('=') + 1 == word.size())
      throw is_empty(word.substr(0, word.size() - 1));
  }
}

// Whoever closed standard input, output or errors must not get the next file or pipe in its place. Input ends
// at once; what is written fails, as it does where nothing is open.
void occupy_closed_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      ::open("/dev/null", O_RDONLY);  // the least free one
}

// The first word where a command or a scene is expected, and it is neither.
void refuse_unknown_command(const CLI::App& program, const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (words.empty() || words.front().starts_with('-') || std::ranges::count(names, words.front()) > 0) return;
  throw CLI::ArgumentMismatch(
      words.front() + " is neither a command nor a file that is there. Commands: " + spoken_list(names));
}

int parse_and_run(const CommandLine& line, std::vector<std::string> words) {
  CLI::App program{line.description};
  program.name(line.program);
  program.formatter(std::make_shared<OrderedHelp>());
  program.footer("Example: " + line.example);
  program.set_version_flag("--version", line.program + " " + version());
  program.require_subcommand(1);
  program.fallthrough();
  CommonOptions common;
  program
      .add_option("--threads", common.threads, "Worker threads (0: all cores); results do not depend on it")
      ->check(CLI::Range(0, kMostThreads));
  program.add_flag("--quiet", common.quiet, "Print errors only");
  program.add_flag("!--no-cache", common.cache,
                   "Keep nothing of scenes that were prepared, and use nothing that was kept");
  std::optional<tbb::global_control> limit;
  program.parse_complete_callback([&] {
    if (common.threads > 0)
      limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(common.threads));
  });
  line.add_commands(program, common);
  refuse_empty_values(&program);
  refuse_empty_values(words);
  try {
    refuse_unknown_command(program, words);
    std::ranges::reverse(words);  // as CLI11 wants them
    program.parse(std::move(words));
    if (std::fflush(stdout) != 0) throw Error("standard output", std::strerror(errno));
    return 0;
  } catch (const CLI::ParseError& error) {
    if (program.exit(error) == 0) return 0;
    return refuses_value(error) ? kCouldNot : kWrongUsage;
  }
}

}  // namespace

CLI::Validator within(double least, double most) {
  const auto check = [least, most](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool good = !text.empty() && !*end && value >= least && value <= most;
    return good ? std::string() : fmt::format("Value {} not in range {} to {}", text, least, most);
  };
  return {check, fmt::format("FLOAT in [{} - {}]", least, most)};
}

int run_command_line(const CommandLine& line, std::vector<std::string> words) {
  occupy_closed_streams();
  g_terminate_before = std::set_terminate(on_terminate);
  std::set_new_handler(on_no_memory);
  try {
    return parse_and_run(line, std::move(words));
  } catch (const std::exception& error) {
    end_progress();
    to_stderr(fmt::format("{}: {}\n", line.program, sentence_of(error)));
  }
  return kCouldNot;
}

}  // namespace splatcut
