// What lies in place of a file that was to be fetched: a pointer of Git LFS, or the answer of a web server.
#pragma once

#include <filesystem>
#include <string_view>

namespace splatcut {

// Throws Error that says what to do where the content, of which the beginning is enough, is such.
void refuse_stand_in(const std::filesystem::path& path, std::string_view content);

}  // namespace splatcut
