// Words for a file that ends too early: first what helps, then the figures.
#pragma once

#include <string>

namespace splatcut {

inline std::string incomplete(const std::string& figures) {
  return "the file is incomplete, copy or download it again (truncated: " + figures + ")";
}

}  // namespace splatcut
