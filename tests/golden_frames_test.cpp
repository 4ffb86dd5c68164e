// Whole frames of the program against stored pictures. SPLATCUT_UPDATE_GOLDENS=1 stores new ones; look at
// them before they are committed. Failures leave NAME.actual.png and NAME.difference.png in the build folder.
#include <doctest/doctest.h>

#include <cstdlib>

#include "headless_app.h"
#include "scene/picture_difference.h"
#include "scene/png_file.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kLevels = 5;
constexpr double kMostPixels = 0.001;

void check_golden(const std::string& name, const Image<Rgb8>& picture) {
  const std::filesystem::path golden =
      std::filesystem::path(SPLATCUT_SOURCE_DIR "/tests/goldens") / (name + ".png");
  const char* update = std::getenv("SPLATCUT_UPDATE_GOLDENS");
  if (update && std::string(update) == "1") {
    write_png(golden, picture);
    return;
  }
  REQUIRE_MESSAGE(std::filesystem::exists(golden), golden.string());
  const Image<Rgb8> expected = read_png_rgb(golden);
  REQUIRE(expected.width() == picture.width());
  REQUIRE(expected.height() == picture.height());
  const PictureDifference d = picture_difference(expected, picture, kLevels);
  if (d.share_beyond > kMostPixels) {
    const std::filesystem::path folder = SPLATCUT_BINARY_DIR "/goldens";
    std::filesystem::create_directories(folder);
    write_png(folder / (name + ".actual.png"), picture);
    write_png(folder / (name + ".difference.png"), difference_picture(expected, picture));
    MESSAGE("see " << (folder / (name + ".actual.png")).string());
  }
  CAPTURE(name);
  CAPTURE(d.largest);
  CHECK(d.share_beyond <= kMostPixels);
}

}  // namespace

TEST_CASE("frames: start page, dark and light") {
  ApplicationOptions options;
  options.sample = kSample;
  HeadlessApp app(1040, 600, 1, options);
  app.frames(3);
  check_golden("start_dark", app.picture());
  app.key('L');
  app.frames(2);
  check_golden("start_light", app.picture());
}

TEST_CASE("frames: the sample with the hint, the keys, twice the scale") {
  HeadlessApp app;
  app.open(kSample);
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("sample", app.picture());
  app.key(key::kF1);
  app.frames(3);
  check_golden("keys", app.picture());
}

TEST_CASE("frames: HiDPI") {
  HeadlessApp app(1600, 900, 1.5f);
  app.frames(3);
  check_golden("start_hidpi", app.picture());
}

TEST_CASE("frames: after one click, alone, side by side") {
  HeadlessApp app;
  app.open(kSample);
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnApple));
  app.move({5, 590});  // no hover
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("clicked", app.picture());
  app.key('I');
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("isolated", app.picture());
  app.key('B');
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("side_by_side", app.picture());
}
