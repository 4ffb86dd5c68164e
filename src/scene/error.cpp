#include "scene/error.h"

#include <fmt/format.h>

namespace splatcut {

namespace {
std::string sentence(std::string_view where, std::string_view what, std::string_view remedy) {
  if (remedy.empty()) return fmt::format("{}: {}.", where, what);
  return fmt::format("{}: {}. {}.", where, what, remedy);
}
}  // namespace

Error::Error(std::string_view where, std::string_view what, std::string_view remedy)
    : std::runtime_error(sentence(where, what, remedy)) {}

}  // namespace splatcut
