#include "core/stand_in.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/error.h"
#include "core/lower_case.h"

namespace splatcut {

void refuse_stand_in(const std::filesystem::path& path, std::string_view content) {
  constexpr std::size_t kLookedAt = 1024;
  const std::string begin = lower_case(std::string(content.substr(0, kLookedAt)));
  if (begin.starts_with("version https://git-lfs"))
    throw Error(path.string(), "is a pointer of Git LFS, not the file", "Fetch the file: git lfs pull");
  constexpr std::string_view kBlankOrMark = " \t\r\n\xef\xbb\xbf";
  const std::string_view text =
      std::string_view(begin).substr(std::min(begin.find_first_not_of(kBlankOrMark), begin.size()));
  const bool page = std::ranges::any_of(std::array{"<!doctype html", "<html", "<head"},
                                        [&](const char* tag) { return text.starts_with(tag); });
  const bool refusal = text.starts_with("<?xml") && text.find("<error>") != text.npos;
  if (page || refusal)
    throw Error(path.string(), "is a web page, not the file that was to be fetched",
                "Fetch it again: the page may ask to log in or to agree");
}

}  // namespace splatcut
