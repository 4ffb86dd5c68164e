// The small pictures of work that is saved by itself.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "app/work/work_file.h"
#include "app/work/work_picture.h"
#include "core/picture_file.h"
#include "core/png_file.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("work that is saved by itself has a small picture of the view, which goes with it") {
  const ScratchFolder folder("state_picture");
  ApplicationOptions options = with_state(folder);
  const auto picture = folder / "autosave.png";
  Image<Rgb8> shown;
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    app.move(app.screen_of(kOnOrange));  // what a click there would change is outlined, and is no work
    REQUIRE(app.settle());
    REQUIRE(app.studio().viewport().style(0).highlight);
    app.studio().apply(RenameObject{app.studio().document().active, "apple"});
    app.frames(60 * 3);
    REQUIRE(app.settle());
    app.move({2, 2});
    REQUIRE(app.settle());
    shown = work_picture(app.studio().viewport().picture()->pictures.front());
  }  // no leave(): as if it had crashed
  CHECK(std::filesystem::file_size(picture) < 30'000);
  CHECK(read_png_rgb(picture) == shown);
  CHECK(shown.width() == kWorkPictureWidthPx);
  CHECK(std::ranges::adjacent_find(shown.pixels(), std::not_equal_to<>()) != shown.pixels().end());
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    REQUIRE(app.studio().work().offers().size() == 1);
    const Image<Rgba8>& offered = app.studio().work().offers().front().picture;
    REQUIRE(offered.width() == shown.width());
    CHECK(offered.at(40, 20) == Rgba8{shown.at(40, 20)[0], shown.at(40, 20)[1], shown.at(40, 20)[2], 255});
    opened(app);
    app.click(app.screen_of(kOnOrange));
    REQUIRE(app.settle());
    app.frames(60 * 3);
    REQUIRE(app.settle());
    CHECK(std::filesystem::exists(folder / "autosave.2.png"));
    app.studio().apply(DropAutosave{app.studio().work().offers().front().file});
    CHECK_FALSE(std::filesystem::exists(picture));
    app.studio().apply(Undo{});
    REQUIRE(app.settle());
    REQUIRE(app.studio().document().objects.empty());
    app.studio().leave();  // nothing is unsaved
  }
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.2.splatcut.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.2.png"));
}

TEST_CASE("a picture of left work that is damaged, huge, no picture or not there hinders nothing") {
  const ScratchFolder folder("state_damaged_picture");
  const auto scene = open_scene(kSmallSample);
  Document document;
  add_object(&document, "mug");
  const auto work = folder / "autosave.splatcut.json", picture = folder / "autosave.png";
  write_work_file(work, *scene, document);
  ApplicationOptions options = with_state(folder);
  const Rgb8 magenta{255, 0, 255};
  const std::string whole = png_bytes(Image<Rgb8>(kWorkPictureWidthPx, 60, magenta));
  // What the list of the start page shows of the picture, in pixels.
  const auto pixels_shown = [&] {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    app.frames(3);
    CHECK(app.button("small_sample.compressed.ply").size().x > 100);
    CHECK(app.button("small_sample.compressed.ply").size().y > 40);
    return std::ranges::count(app.picture().pixels(), magenta);
  };
  const auto put = [&](const std::string& bytes) { std::ofstream(picture, std::ios::binary) << bytes; };
  CHECK(pixels_shown() == 0);
  put(whole);
  CHECK(pixels_shown() > 2500);
  for (const std::size_t bytes : {0, 1, 20, 40, 70}) {
    put(whole.substr(0, bytes));
    CHECK(pixels_shown() == 0);
  }
  put("no picture at all, but some text");
  CHECK(pixels_shown() == 0);
  put(png_bytes(Image<Rgb8>(3000, 3000, magenta)));
  CHECK(pixels_shown() == 0);
  std::filesystem::remove(picture);
  std::filesystem::create_directories(picture / "in it");
  CHECK(pixels_shown() == 0);
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
  app.studio().apply(OpenScene{work});
  REQUIRE(app.settle());
  CHECK(app.studio().document().objects.size() == 1);
  app.frames(60 * 3);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "autosave.2.splatcut.json"));
  CHECK_FALSE(std::filesystem::exists(work));
}

TEST_CASE("the small picture of a view of any size and shape is 96 pixels wide at most") {
  CHECK(work_picture({}).empty());
  const auto size = [](int width, int height) {
    const Image<Rgb8> small = work_picture(Image<Rgba8>(width, height, {1, 2, 3, 255}));
    CHECK(std::ranges::all_of(small.pixels(), [](const Rgb8& c) { return c == Rgb8{1, 2, 3}; }));
    return std::pair(small.width(), small.height());
  };
  CHECK(size(960, 600) == std::pair(96, 60));
  CHECK(size(1, 1) == std::pair(1, 1));
  CHECK(size(5000, 1) == std::pair(96, 1));
  CHECK(size(3, 5000) == std::pair(3, 192));
}
