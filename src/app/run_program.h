// Runs another program and waits for it.
#pragma once

#include <string>
#include <vector>

namespace splatcut {

// words: the program, looked up on PATH, then its arguments; no shell reads them. Its exit code, or -1 where it could not
// be started or a signal ended it.
int run_program(const std::vector<std::string>& words);

}  // namespace splatcut
