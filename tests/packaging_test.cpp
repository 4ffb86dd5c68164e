// What a desktop is told of our files follows from the table of formats; what scripts run is built.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "core/mapped_file.h"
#include "places.h"
#include "scene/formats/scene_formats.h"

using namespace splatcut;

namespace {

const std::filesystem::path kPackaging = splatcut::testing::project_folder() + "/packaging";

// What stands between `before` and `after`, wherever it does.
std::set<std::string> all_between(const std::string& text, const std::string& before,
                                  const std::string& after) {
  std::set<std::string> found;
  for (std::size_t at = 0; (at = text.find(before, at)) != std::string::npos;) {
    at += before.size();
    found.insert(text.substr(at, text.find(after, at) - at));
  }
  return found;
}

}  // namespace

TEST_CASE("packaging: every ending that is ours alone is a file type") {
  std::set<std::string> ours = {".splatcut.json"};
  const std::set<std::string> others = {".ply", ".glb", ".gltf"};  // of programs that know no splats, too
  for (const SceneFormat& format : read_formats())
    for (const std::string ending : {format.extension, format.also})
      if (ending.starts_with('.') && !others.contains(ending)) ours.insert(ending);
  CHECK(all_between(text_of_file(kPackaging / "splatcut.xml"), "<glob pattern=\"*", "\"") == ours);
}

TEST_CASE("packaging: the desktop entry opens every file type, and no other") {
  const std::string entry = text_of_file(kPackaging / "splatcut.desktop");
  const std::string list = *all_between(entry, "MimeType=", "\n").begin();
  const auto types = all_between(text_of_file(kPackaging / "splatcut.xml"), "<mime-type type=\"", "\"");
  CHECK(all_between(";" + list, ";", ";").size() == types.size() + 1);  // what follows the last ; is empty
  for (const std::string& type : types)
    CHECK_MESSAGE((";" + list).find(";" + type + ";") != std::string::npos, type);
}

TEST_CASE("scripts run programs of tests that are built") {
  const std::filesystem::path tests = splatcut::testing::project_folder() + "/tests";
  const std::string built = text_of_file(tests / "CMakeLists.txt");
  std::size_t runs = 0;
  for (const auto& file : std::filesystem::directory_iterator(tests)) {
    if (file.path().extension() != ".sh") continue;
    for (const std::string& name : all_between(text_of_file(file.path()), "\"$build/tests/", "\"")) {
      ++runs;
      CHECK_MESSAGE(built.find("_test(" + name + " ") != std::string::npos, file.path() << " runs " << name);
    }
  }
  CHECK(runs > 0);
}
