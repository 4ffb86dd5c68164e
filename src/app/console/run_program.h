// Runs another program and waits for it.
#pragma once

#include <string>
#include <vector>

#include "core/job.h"

namespace splatcut {

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
