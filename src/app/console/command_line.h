// What both programs share: the options of every subcommand, exit codes, and errors as sentences.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/console/user_folders.h"
#include "segment/superpoints/prepared_scene.h"

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace splatcut {

// What every subcommand shares.
struct CommonOptions {
  int threads = 0;  // 0: all cores
  bool quiet = false;
  bool cache = true;  // scenes once prepared are kept in the user's cache folder
};

inline PreparedCache prepared_cache(const CommonOptions& common) {
  PreparedCache cache;
  if (common.cache) cache.folder = cache_folder();
  return cache;
}

struct CommandLine {
  std::string program, description, example;
  std::function<void(CLI::App&, const CommonOptions&)> add_commands;
};

// As CLI::Range, but that NaN is not within.
CLI::Validator within(double least, double most);

// words: what follows the program's name. Returns the exit code: 0 done, 1 could not (a sentence on stderr
// says why), 2 wrong usage.
int run_command_line(const CommandLine& line, std::vector<std::string> words);

}  // namespace splatcut
