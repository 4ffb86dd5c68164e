// What output refuses, and programs that are killed while they write.
#pragma once

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>

#include "core/error.h"

namespace splatcut::testing {

inline std::string what_is_said(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline bool says(const std::function<void()>& work, const std::string& part) {
  const std::string said = what_is_said(work);
  CAPTURE(said);
  CHECK(said.find(part) != std::string::npos);
  return said.find(part) != std::string::npos;
}

// Work that is killed before it ends: no destructor runs.
inline void killed_after(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  REQUIRE(::waitpid(child, nullptr, 0) == child);
}

}  // namespace splatcut::testing
