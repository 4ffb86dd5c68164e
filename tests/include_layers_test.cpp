// Reads the #include lines of src/ and refuses what the architecture forbids between layers.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

using Prefixes = std::vector<std::string>;

// Of a folder, without those of its folders that have a line of their own. The product never knows the
// laboratory; the laboratory knows no window.
const std::map<std::string, Prefixes> kForbidden = {
    {"scene",
     {"scene/still_life/", "segment/", "render/", "app/", "opencv2/", "GL/", "GLFW/", "imgui", "epoxy/",
      "EGL/"}},
    {"scene/still_life",
     {"segment/", "render/", "app/", "opencv2/", "GL/", "GLFW/", "imgui", "epoxy/", "EGL/"}},
    {"segment", {"scene/still_life/", "render/", "app/", "GL/", "GLFW/", "imgui", "epoxy/", "EGL/"}},
    {"render", {"scene/still_life/", "segment/", "app/", "opencv2/", "imgui"}},
    {"app", {"scene/still_life/", "app/lab/"}},
    {"app/lab", {"render/", "app/studio/", "app/ui/", "GL/", "GLFW/", "imgui", "epoxy/", "EGL/"}},
};

// The deepest folder with a line of its own that holds the file.
const std::string& layer_of(const std::string& file) {
  const std::string* layer = nullptr;
  for (const auto& [folder, forbidden] : kForbidden)
    if (file.starts_with(folder + "/") && (!layer || folder.size() > layer->size())) layer = &folder;
  REQUIRE_MESSAGE(layer, file);
  return *layer;
}

// What an #include line names, or nothing.
std::string included_by(const std::string& line) {
  return line.starts_with("#include") ? line.substr(line.find_first_of("<\"") + 1) : std::string();
}

bool header(const std::filesystem::path& path) {
  return path.extension() == ".h";
}

}  // namespace

TEST_CASE("no layer includes a layer above it") {
  const std::filesystem::path src = std::filesystem::path(SPLATCUT_SOURCE_DIR) / "src";
  std::map<std::string, int> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".h" && path.extension() != ".cpp") continue;
    const std::string& layer = layer_of(std::filesystem::relative(path, src).string());
    ++files[layer];
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
      const std::string included = included_by(line);
      CAPTURE(path.filename().string());
      CAPTURE(line);
      for (const std::string& prefix : kForbidden.at(layer)) CHECK_FALSE(included.starts_with(prefix));
      // cv_image.h is the bridge to OpenCV: .cpp files may include it, headers may not.
      if (layer == "segment" && header(path) && path.filename() != "cv_image.h") {
        CHECK_FALSE(included.starts_with("segment/cv_image.h"));
        CHECK_FALSE(included.starts_with("opencv2/"));
        CHECK_FALSE(included.starts_with("nanoflann"));
      }
    }
  }
  for (const auto& [layer, forbidden] : kForbidden) CHECK_MESSAGE(files[layer] > 5, layer);
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
