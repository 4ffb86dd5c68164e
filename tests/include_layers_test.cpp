// Reads the #include lines of src/ and refuses what the architecture does not allow between its rooms.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "places.h"

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

Names both(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Names kScene = {"scene/cloud", "scene/camera", "scene/raster", "scene/packing", "scene/formats"};
const Names kSegment = {"segment/graphcut", "segment/masks",     "segment/superpoints",
                        "segment/finish",   "segment/selection", "segment/session"};

// What a room may include beside itself and core/: other rooms, and libraries that not everyone may know. No
// room knows one that stands below it here. The product never knows still lifes or the laboratory, the
// laboratory no window.
struct Room {
  std::string folder;
  Names rooms;
  Names libraries = {};
  int most_lines = 3300;  // of code, without comments, braces and includes
};
const std::vector<Room> kRooms = {
    {"core", {}, {"nlohmann", "webp", "xxhash"}},
    {"scene/cloud", {}, {"libqhull_r/"}},
    {"scene/camera", {"scene/cloud"}},
    {"scene/raster", {"scene/cloud", "scene/camera"}},
    {"scene/packing", {}, {"webp", "zip"}},
    {"scene/formats",
     {"scene/cloud", "scene/camera", "scene/raster", "scene/packing"},
     {"nlohmann"},
     4300},  // a file a format
    {"scene/still_life", {"scene/cloud", "scene/camera", "scene/raster"}, {"nlohmann"}},
    {"segment/graphcut", {"scene/cloud", "scene/camera", "scene/raster"}, {"nanoflann"}},
    {"segment/masks", {"scene/cloud", "scene/camera", "scene/raster", "segment/graphcut"}, {"opencv2/"}},
    {"segment/superpoints", {"scene/cloud", "scene/camera", "scene/raster", "segment/graphcut"}},
    {"segment/finish",
     {"scene/cloud", "scene/camera", "scene/raster", "segment/graphcut", "segment/masks",
      "segment/superpoints"}},
    {"segment/selection", both(kScene, {"segment/graphcut", "segment/masks", "segment/superpoints"})},
    {"segment/session",
     both(kScene, {"segment/graphcut", "segment/masks", "segment/superpoints", "segment/selection"})},
    {"render", {"scene/cloud", "scene/camera", "scene/raster"}, {"glad/", "GL/", "EGL/"}},
    {"app/console", both(kScene, kSegment), {"CLI/", "nlohmann"}},
    {"app/placing", kScene},
    {"app/document", both(both(kScene, kSegment), {"app/placing", "app/console"})},
    {"app/picture", both(both(kScene, kSegment), {"app/placing", "app/console", "app/document"}), {"webp"}},
    {"app/tools", both(both(kScene, kSegment), {"app/placing", "app/document", "app/picture"})},
    {"app/work", both(both(kScene, kSegment), {"app/console", "app/document"}), {"nlohmann"}},
    {"app/workspace", both(both(kScene, kSegment), {"app/document", "app/picture", "app/tools"})},
    {"app/studio", both(both(kScene, kSegment), {"app/placing", "app/console", "app/document", "app/picture",
                                                 "app/tools", "app/work", "app/workspace"})},
    {"app/ui",
     both(both(kScene, kSegment), {"render", "app/console", "app/document", "app/picture", "app/tools",
                                   "app/work", "app/placing", "app/workspace", "app/studio"}),
     {"glad/", "GL/", "EGL/", "imgui"}},
    {"app/viewport",
     both(both(kScene, kSegment), {"app/document", "app/picture", "app/tools", "app/work", "app/placing",
                                   "app/workspace", "app/studio", "app/ui"}),
     {"imgui"}},
    {"app/window",
     both(both(kScene, kSegment),
          {"render", "app/console", "app/document", "app/picture", "app/tools", "app/work", "app/placing",
           "app/workspace", "app/studio", "app/ui", "app/viewport"}),
     {"glad/", "GL/", "EGL/", "GLFW/", "imgui", "X11/"}},
    {"app/cli",
     both(both(kScene, kSegment), {"app/placing", "app/console", "app/document", "app/work", "app/window"}),
     {"CLI/", "nlohmann"}},
    {"app/measure", both(both(kScene, kSegment), {"scene/still_life", "app/console"}), {"nlohmann"}},
    {"app/lab",
     both(both(kScene, kSegment), {"scene/still_life", "app/console", "app/measure"}),
     {"CLI/", "nlohmann"}},
    {"app", {"scene/formats", "app/console", "app/cli"}, {"CLI/"}},  // main()
};
// Libraries that not every room may know. TBB is everywhere, but in headers: it takes long to read.
const Names kLibraries = {"opencv2/", "nanoflann", "glad/",    "GL/",  "EGL/",   "GLFW/", "imgui",
                          "CLI/",     "X11/",      "nlohmann", "webp", "xxhash", "zip",   "libqhull_r/"};

bool starts_with_any(const std::string& text, const Names& starts) {
  return std::ranges::any_of(starts, [&](const std::string& s) { return text.starts_with(s); });
}

// The deepest room that holds the file; none for what is not ours.
const Room* room_of(const std::string& file) {
  const Room* room = nullptr;
  for (const Room& r : kRooms)
    if (file.starts_with(r.folder + "/") && (!room || r.folder.size() > room->folder.size())) room = &r;
  return room;
}

// What an #include line names, or nothing.
std::string included_by(const std::string& line) {
  if (!line.starts_with("#include")) return {};
  const std::size_t from = line.find_first_of("<\"") + 1;
  return line.substr(from, line.find_first_of(">\"", from) - from);
}

bool is_code(const std::string& line) {
  const std::size_t from = line.find_first_not_of(" ");
  if (from == std::string::npos || line.starts_with("#include")) return false;
  return line.compare(from, 2, "//") != 0 && line.find_first_not_of("{}();, ") != std::string::npos;
}

bool may_include(const Room& room, const std::string& included) {
  if (const Room* theirs = room_of(included))
    return theirs == &room || theirs->folder == "core" || std::ranges::count(room.rooms, theirs->folder);
  return !starts_with_any(included, kLibraries) || starts_with_any(included, room.libraries);
}

}  // namespace

TEST_CASE("no room includes what it must not know") {
  const fs::path src = fs::path(splatcut::testing::project_folder()) / "src";
  std::map<std::string, int> files;
  for (const auto& entry : fs::recursive_directory_iterator(src)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".h" && path.extension() != ".cpp") continue;
    const Room* room = room_of(fs::relative(path, src).string());
    REQUIRE_MESSAGE(room, path);
    ++files[room->folder];
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
      const std::string included = included_by(line);
      CHECK_MESSAGE(may_include(*room, included), path.string(), ": ", line);
      // All other commands are built without a window, too.
      if (room->folder == "app/cli" && path.filename() != "view_command.cpp")
        CHECK_MESSAGE(!included.starts_with("app/window/"), path.string(), ": ", line);
      // cv_image.h is the bridge to OpenCV: sources may include it, headers may not.
      if (path.extension() == ".h" && path.filename() != "cv_image.h")
        CHECK_MESSAGE(
            !starts_with_any(included, {"segment/masks/cv_image.h", "opencv2/", "nanoflann", "CLI/",
                                        "tbb/task_arena", "X11/", "webp", "xxhash", "zip.", "libqhull_r/"}),
            path.string(), ": ", line);
    }
  }
  for (const Room& room : kRooms)
    CHECK_MESSAGE(files[room.folder] >= (room.folder == "app" ? 1 : 4), room.folder);
}

TEST_CASE("no room grows beyond what one can know") {
  const fs::path src = fs::path(splatcut::testing::project_folder()) / "src";
  std::map<std::string, int> lines;
  for (const auto& entry : fs::recursive_directory_iterator(src)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    int& count = lines[room_of(fs::relative(entry.path(), src).string())->folder];
    for (std::string line; std::getline(in, line);) count += is_code(line);
  }
  for (const Room& room : kRooms) {
    MESSAGE(room.folder, ": ", lines[room.folder]);
    CHECK_MESSAGE(lines[room.folder] <= room.most_lines, room.folder);
  }
}

TEST_CASE("the table of rooms has no cycle and knows no room that is not there") {
  for (std::size_t i = 0; i < kRooms.size(); ++i)
    for (const std::string& below : kRooms[i].rooms) {
      const auto at = std::ranges::find(kRooms, below, &Room::folder);
      REQUIRE_MESSAGE(at != kRooms.end(), below);
      CHECK_MESSAGE(at - kRooms.begin() < static_cast<std::ptrdiff_t>(i), kRooms[i].folder, " -> ", below);
    }
}

TEST_CASE("no test depends on what lies beside the project") {
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(splatcut::testing::project_folder()) / "tests")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      if (line.find("project_folder()") != std::string::npos)
        CHECK_MESSAGE(line.find("..") == std::string::npos, entry.path().string(), ": ", line);
  }
}

// CMake takes a semicolon for the end of a list's item: such a case would be found by doctest and run by
// nobody.
TEST_CASE("no test case has a semicolon in its name") {
  int names = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(splatcut::testing::project_folder()) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("TEST_CASE(\"") && !line.starts_with("QUICK_CASE(\"")) continue;
      ++names;
      CAPTURE(line);
      CHECK(line.find(';') == std::string::npos);
    }
  }
  CHECK(names > 200);
}
