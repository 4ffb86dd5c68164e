// Stand-ins of programs that others are asked to run.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace splatcut::testing {

// PATH holds this folder alone until it goes; programs put there are all that can be found.
class OnlyPath {
 public:
  explicit OnlyPath(const std::filesystem::path& folder) : before_(std::getenv("PATH")), folder_(folder) {
    ::setenv("PATH", folder.c_str(), 1);
  }
  ~OnlyPath() { ::setenv("PATH", before_.c_str(), 1); }
  OnlyPath(const OnlyPath&) = delete;
  OnlyPath& operator=(const OnlyPath&) = delete;

  // Notes its arguments, one a line, and answers.
  void put(const std::string& program, const std::string& answer) const {
    const auto file = folder_ / program;
    std::ofstream(file) << "#!/bin/sh\nprintf '%s\\n' \"$0\" \"$@\" >'" << (folder_ / "asked").string()
                        << "'\n"
                        << answer << "\n";
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  std::string asked() const {
    std::ifstream in(folder_ / "asked");
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::string before_;
  std::filesystem::path folder_;
};

}  // namespace splatcut::testing
