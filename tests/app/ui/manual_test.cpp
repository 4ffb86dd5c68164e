// docs/manual.md has every key and every tool of the program, by the program's own words, and no other.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "app/tools/actions.h"
#include "app/tools/tool.h"
#include "app/ui/panels.h"
#include "places.h"
#include "scene/formats/scene_formats.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The first two cells of each row of the tables below a heading, up to the next heading of its level.
std::set<std::string> rows_below(const std::string& heading) {
  std::ifstream in(project_folder() + "/docs/manual.md");
  std::set<std::string> rows;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("## ")) inside = line == heading;
    if (!inside || !line.starts_with("| `")) continue;
    const std::size_t second = line.find('|', line.find("` |") + 3);
    rows.insert(line.substr(0, second + 1));
  }
  return rows;
}

std::string row_of(const std::string& keys, const std::string& what) {
  return "| `" + keys + "` | " + what + " |";
}

}  // namespace

TEST_CASE("manual: every key, and no other") {
  std::set<std::string> expected;
  for (const Binding& b : key_bindings())
    if (!tool_of(b.action)) expected.insert(row_of(keys_of(b.action), name_of(b.action)));
  CHECK(expected.size() > 40);
  CHECK(rows_below("## Keys") == expected);
}

TEST_CASE("manual: every tool, and no other") {
  std::set<std::string> expected;
  for (const Tool* tool : tools()) expected.insert(row_of(keys_of(action_of(*tool)), tool->name));
  CHECK(rows_below("## Tools") == expected);
}

TEST_CASE("manual: README names the endings that the start page names") {
  std::ifstream in(project_folder() + "/README.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string endings = spoken_endings(read_formats(), "or");
  CAPTURE(endings);
  CHECK(endings.find(".gltf") != std::string::npos);
  CHECK(endings.find("meta.json") == std::string::npos);
  CHECK(text.find("opens a scene: " + endings + "\n") != std::string::npos);
}

TEST_CASE("manual: the page of keys says of clicks and drags what tooltips and the manual say") {
  const std::string page = pointer_words();
  for (const Tool* tool : {&Tool::kClick, &Tool::kNavigate}) CHECK(page.find(tool->sentence) != page.npos);
  std::ifstream in(project_folder() + "/docs/manual.md");
  const std::string manual{std::istreambuf_iterator<char>(in), {}};
  for (const char* said : {"left click", "right click", "left drag turns", "right drag shifts",
                           "middle drag turns", "click on the dot"}) {
    CAPTURE(std::string(said));
    CHECK(page.find(said + 1) != page.npos);  // its first letter may be large
    CHECK(manual.find(said + 1) != manual.npos);
  }
}
