// Other programs: started, or run to their end.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "core/job.h"

namespace splatcut {

// Starts a program, which is looked up on PATH, with arguments; no shell reads them. output: descriptor that
// it prints to. group: process group that it joins, 0 for one of its own; none: that of this process. input:
// descriptor that it reads from; none: it reads nothing. Returns errno if it cannot be started, else 0 and
// its process in `child`.
int start_program(const std::vector<std::string>& words, int output, std::optional<pid_t> group, pid_t* child,
                  std::optional<int> input = {});

struct ProgramEnd {
  int start_error = 0;  // errno where it could not be started
  int exit_code = -1;   // -1 where a signal ended it
  int signal = 0;
};

// words: the program, looked up on PATH, then its arguments; no shell reads them. A cancelled job ends it and
// what it started; so does the end of this process, however it ends. It reads nothing, and what it prints
// goes to stderr.
ProgramEnd run_program(const std::vector<std::string>& words, const Job& job);

bool on_path(const std::string& program);  // whether it can be started by that name

}  // namespace splatcut
