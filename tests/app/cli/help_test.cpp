// What is made of --help: the manual page, the completion of bash; and docs/manual.md, which agrees with it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "program_runner.h"

using namespace splatcut::testing;

namespace {

const char* const kCommands[] = {"info",    "render", "cut",     "batch", "serve",
                                 "convert", "merge",  "compare", "view"};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// "--spz-axes" of "  --spz-axes TEXT:{ply,rub}   Axes ..."; "--output" of "  -o,--output TEXT".
std::set<std::string> options_in_help(const std::string& help) {
  std::set<std::string> options;
  for (const std::string& line : lines_of(help)) {
    const std::size_t start = line.find("--");
    if (!line.starts_with("  -") || start > 5) continue;
    options.insert(line.substr(start, line.find_first_of(" {", start) - start));
  }
  return options;
}

std::string troff_of(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

// What bash offers where the last of the words is being typed.
std::set<std::string> offered(const Workplace& place, const std::string& words) {
  place.write(
      "ask.sh",
      "PATH=" + std::filesystem::path(splatcut_program()).parent_path().string() + ":$PATH\nsource " +
          project_folder() + "/packaging/splatcut.bash\nCOMP_WORDS=(" + words +
          ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_splatcut\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  const Result result = place.run_program("/bin/bash", "ask.sh");
  CHECK(result.code == 0);
  CHECK(result.err.empty());
  std::set<std::string> set;
  for (const std::string& line : lines_of(result.out))
    if (!line.empty()) set.insert(line);
  return set;
}

}  // namespace

TEST_CASE("the manual page has every command and option of --help") {
  const Workplace place;
  const std::filesystem::path page_gz =
      std::filesystem::path(splatcut_program()).parent_path() / "packaging/splatcut.1.gz";
  place.write("unpack.sh", "gzip -dc " + page_gz.string() + "\n");
  const std::string page = place.run_program("/bin/bash", "unpack.sh").out;
  CHECK(page.find("splatcut " + place.run("--version").out.substr(9, 3)) != std::string::npos);
  for (const char* part : {".SH NAME", ".SH \"EXIT STATUS\"", ".SH FILES"})
    CHECK(page.find(part) != std::string::npos);
  for (const char* command : kCommands) {
    const std::string help = place.run(command + std::string(" --help")).out;
    std::string title = "SPLATCUT " + std::string(command);
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
    const std::size_t section = page.find(".SH \"" + title + "\"");
    REQUIRE_MESSAGE(section != std::string::npos, title);
    const std::string text = page.substr(section, page.find("\n.SH", section + 1) - section);
    for (const std::string& option : options_in_help(help)) {
      CAPTURE(option);
      CHECK((option == "--help" || text.find(troff_of(option)) != std::string::npos));
    }
  }
}

TEST_CASE("bash completes commands, options and words to choose from, and leaves the rest to files") {
  const Workplace place;
  CHECK(offered(place, "splatcut ''") == std::set<std::string>(std::begin(kCommands), std::end(kCommands)));
  CHECK(offered(place, "splatcut co") == std::set<std::string>{"convert", "compare"});
  CHECK(offered(place, "splatcut --v") == std::set<std::string>{"--version"});
  CHECK(offered(place, "splatcut render --wh") == std::set<std::string>{"--what"});
  CHECK(offered(place, "splatcut render a.ply --what ''") ==
        std::set<std::string>{"colour", "depth", "alpha", "labels"});
  CHECK(offered(place, "splatcut render a.ply --what = d") == std::set<std::string>{"depth"});
  CHECK(offered(place, "splatcut convert a.ply -o ''").empty());
  CHECK(offered(place, "splatcut cut ''").empty());
  CHECK(offered(place, "splatcut a.ply --ren") == std::set<std::string>{"--renderer"});
  for (const char* command : kCommands) {
    std::set<std::string> options = options_in_help(place.run(command + std::string(" --help")).out);
    options.insert({"--version", "--threads", "--quiet", "--no-cache"});
    CHECK(offered(place, "splatcut " + std::string(command) + " --") == options);
  }
}

TEST_CASE("docs/manual.md has every option of every command, and no other") {
  const Workplace place;
  std::map<std::string, std::set<std::string>> in_manual;
  std::ifstream in(project_folder() + "/docs/manual.md");
  std::string command;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("#")) command = line.starts_with("### ") ? line.substr(4) : "";
    if (command.starts_with("splatcut ") || command == "Every command")
      if (line.starts_with("| `-")) {
        const std::size_t start = line.find("--");
        in_manual[command].insert(line.substr(start, line.find_first_of(" `", start) - start));
      }
  }
  const std::set<std::string> of_all = options_in_help(place.run("--help").out);
  CHECK(in_manual["Every command"] == of_all);
  for (const std::string name : kCommands) {
    CAPTURE(name);
    std::set<std::string> options = options_in_help(place.run(name + " --help").out);
    options.erase("--help");
    CHECK(in_manual["splatcut " + name] == options);
  }
  CHECK(in_manual.size() == std::size(kCommands) + 1);
}
