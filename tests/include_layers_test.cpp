// Reads the #include lines of src/ and refuses what the architecture forbids between layers.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

const std::map<std::string, std::vector<std::string>> kForbidden = {
    {"scene", {"segment/", "render/", "app/", "opencv2/", "GL/", "GLFW/", "imgui", "epoxy/", "EGL/"}},
    {"segment", {"render/", "app/", "GL/", "GLFW/", "imgui", "epoxy/", "EGL/"}},
    {"render", {"segment/", "app/", "opencv2/", "imgui"}},
};

bool header(const std::filesystem::path& path) {
  return path.extension() == ".h";
}

}  // namespace

TEST_CASE("no layer includes a layer above it") {
  const std::filesystem::path src = std::filesystem::path(SPLATCUT_SOURCE_DIR) / "src";
  int files = 0;
  for (const auto& [layer, forbidden] : kForbidden) {
    if (!std::filesystem::exists(src / layer)) continue;  // a layer that has no code yet
    for (const auto& entry : std::filesystem::recursive_directory_iterator(src / layer)) {
      if (!entry.is_regular_file()) continue;
      ++files;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("#include")) continue;
        const std::string included = line.substr(line.find_first_of("<\"") + 1);
        CAPTURE(entry.path().filename().string());
        CAPTURE(line);
        for (const std::string& prefix : forbidden) CHECK_FALSE(included.starts_with(prefix));
        // cv_image.h is the bridge to OpenCV: .cpp files may include it, headers may not.
        if (layer == "segment" && header(entry.path()) && entry.path().filename() != "cv_image.h") {
          CHECK_FALSE(included.starts_with("segment/cv_image.h"));
          CHECK_FALSE(included.starts_with("opencv2/"));
          CHECK_FALSE(included.starts_with("nanoflann"));
        }
      }
    }
  }
  CHECK(files > 20);
}

// CMake takes a semicolon for the end of a list's item: such a case would be found by doctest and run by
// nobody.
TEST_CASE("no test case has a semicolon in its name") {
  int names = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(SPLATCUT_SOURCE_DIR) / "tests")) {
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("TEST_CASE(\"")) continue;
      ++names;
      CAPTURE(line);
      CHECK(line.find(';') == std::string::npos);
    }
  }
  CHECK(names > 100);
}
