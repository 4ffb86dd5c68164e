#include "core/error.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <system_error>

namespace splatcut {

namespace {
std::string sentence(std::string_view where, std::string_view what, std::string_view remedy) {
  const std::string fact = where.empty() ? std::string(what) : fmt::format("{}: {}", where, what);
  if (remedy.empty()) return fact + ".";
  return fmt::format("{}. {}.", fact, remedy);
}
}  // namespace

std::string sentence_of(const std::exception& error) {
  if (dynamic_cast<const Error*>(&error)) return error.what();
  const bool opencv =
      std::string_view(error.what()).find("(-4:Insufficient memory)") != std::string_view::npos;
  if (opencv || dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
    return "There is not enough memory for this. Close other programs, or use a smaller scene or fewer "
           "views.";
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return sentence(file->path1().string(), file->code().message(), {});
  if (const auto* system = dynamic_cast<const std::system_error*>(&error))
    return fmt::format("The system says: {}.", system->code().message());
  return "This was stopped by a defect of the program. Please report it with the command and its files.";
}

Error::Error(std::string_view where, std::string_view what, std::string_view remedy)
    : std::runtime_error(sentence(where, what, remedy)) {}

std::string_view Error::unstopped() const {
  std::string_view said = what();
  said.remove_suffix(1);
  return said;
}

}  // namespace splatcut
