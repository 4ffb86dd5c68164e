// Turntables as pictures, animation and video.
#include <doctest/doctest.h>

#include <webp/demux.h>

#include <tuple>

#include "app/picture/animated_webp.h"
#include "core/error.h"
#include "core/picture_file.h"
#include "headless_app.h"
#include "only_path.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("dialogs: the turntable writes as many pictures of the size asked for") {
  const ScratchFolder folder("turntable");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  UiState& state = app.interface_state();
  state.turntable_open = true;
  app.frames(3);
  CHECK(app->interface().dialog_open());
  CHECK(state.turntable.width_px == app.studio().viewport().pane_camera().width_px);
  state.turntable = {5, 96, 64, (folder / "turn").string()};
  app.frames(1);
  app.press_item("###turntable", {"Save"});
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "turn")) {
    const Image<Rgb8> picture = read_png_rgb(entry.path());
    CHECK(picture.width() == 96);
    CHECK(picture.height() == 64);
    ++files;
  }
  CHECK(files == 5);
  app.studio().apply(SaveTurntable{folder / "none", 1});
  CHECK(app.studio().messages().back().kind == Message::Kind::kRefused);
  app.studio().apply(SaveTurntable{folder / "none", 5, 100000, 5});
  CHECK(app.studio().messages().back().kind == Message::Kind::kRefused);
  CHECK_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_CASE("dialogs: no tooltip of a dialog comes before the pointer has moved in it") {
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  UiState& state = app.interface_state();
  const auto tip = [&] { return app.window("##Tooltip").size().x > 0; };
  state.turntable_open = true;
  app.frames(3);
  const glm::vec2 on_save = app.button("Save").min + 8.0f;
  state.turntable_open = false;
  app.key(key::kEscape);
  app.frames(3);
  REQUIRE_FALSE(app->interface().dialog_open());
  app.move(on_save);
  app->advance(1);
  for (int again = 0; again < 2; ++again) {
    state.turntable_open = true;
    app.frames(5);
    app->advance(2);
    CHECK_FALSE(tip());
    app.move(on_save + 2.0f);
    app.frames(2);
    CHECK(tip());
    app.move(on_save);
    app.frames(2);
    CHECK(tip());
    app.key(key::kEscape);
    app.frames(3);
    REQUIRE_FALSE(app->interface().dialog_open());
  }
}

TEST_CASE("dialogs: the turntable as an animated WebP is one that readers of WebP know") {
  const ScratchFolder folder("turntable_webp");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  const auto file = folder / "turn.webp";
  app.studio().apply(SaveTurntable{file, 6, 97, 64, TurntableAs::kWebp, 1.5f});
  REQUIRE(app.settle());
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  REQUIRE(bytes.size() > 1000);
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  WebPDemuxer* demuxer = WebPDemux(&data);
  REQUIRE(demuxer);
  CHECK(WebPDemuxGetI(demuxer, WEBP_FF_CANVAS_WIDTH) == 97);
  CHECK(WebPDemuxGetI(demuxer, WEBP_FF_CANVAS_HEIGHT) == 64);
  CHECK(WebPDemuxGetI(demuxer, WEBP_FF_FRAME_COUNT) == 6);
  CHECK(WebPDemuxGetI(demuxer, WEBP_FF_LOOP_COUNT) == 0);
  WebPDemuxDelete(demuxer);
  WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, nullptr);
  REQUIRE(decoder);
  int frames = 0, time_ms = 0;
  while (WebPAnimDecoderHasMoreFrames(decoder)) {
    std::uint8_t* rgba = nullptr;
    REQUIRE(WebPAnimDecoderGetNext(decoder, &rgba, &time_ms));
    CHECK(rgba[3] == 0);                                             // nothing in the corner
    CHECK(rgba[4 * (32 * 97 + 48) + 3] > 200);                       // the apple in the middle
    CHECK(rgba[4 * (32 * 97 + 48)] > rgba[4 * (32 * 97 + 48) + 2]);  // which is red
    ++frames;
  }
  WebPAnimDecoderDelete(decoder);
  CHECK(frames == 6);
  CHECK(time_ms == 1500);
}

TEST_CASE("dialogs: an animation larger than its format can hold is refused before it is written") {
  const Image<Rgba8> picture(32, 32, Rgba8{200, 30, 30, 255});
  AnimatedWebp one(40);
  one.add(picture);
  const std::size_t bytes = one.bytes().size();
  AnimatedWebp small(40, bytes + 64);
  small.add(picture);
  CHECK(small.bytes().size() == bytes);
  CHECK_THROWS_AS(small.add(picture), Error);
  CHECK(AnimatedWebp::kMostBytes <= 0xffffffff);
}

TEST_CASE("dialogs: the turntable as a video is made by ffmpeg, and its failure is told") {
  const ScratchFolder folder("turntable_video");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  const auto file = folder / "turn.mp4";
  const auto save = [&] {
    app.studio().apply(SaveTurntable{file, 4, 96, 64, TurntableAs::kVideo, 2});
    REQUIRE(app.settle());
    return app.studio().messages().back().text;
  };
  {
    const OnlyPath path(folder.path());
    CHECK(save().find("ffmpeg: is not installed") != std::string::npos);
    path.put("ffmpeg", "exit 3");
    CHECK(save().find("could not make the video") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(file));
    // The last argument is the file to make.
    path.put("ffmpeg", "for last; do :; done; echo made >\"$last\"");
    CHECK(save().find("4 pictures saved") != std::string::npos);
    CHECK(path.asked().find("-framerate\n2.0000\n") != std::string::npos);
    CHECK(path.asked().find("frame_%04d.png") != std::string::npos);
  }
  std::ifstream in(file);
  std::string text;
  std::getline(in, text);
  CHECK(text == "made");
}

TEST_CASE("dialogs: the turntable goes where the last export went, and asks before it replaces a file") {
  const ScratchFolder folder("turntable_place");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app, kSmallSample));
  UiState& state = app.interface_state();
  app.studio().apply(Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "apple.ply"}});
  REQUIRE(app.settle());
  const auto open = [&] {
    const UiRect button = app.button(icon::kFilm);
    app.click(0.5f * (button.min + button.max));
    app.frames(3);
    REQUIRE(state.turntable_open);
  };
  open();
  CHECK(std::filesystem::path(state.turntable.path).parent_path() == folder.path());
  for (const auto& [as, name, written] :
       {std::tuple{TurntableAs::kWebp, "turn.webp", "turn.webp"},
        std::tuple{TurntableAs::kPictures, "turn", "turn/frame_0000.png"}}) {
    CAPTURE(name);
    std::filesystem::create_directories((folder / written).parent_path());
    std::ofstream(folder / written) << "mine";
    state.turntable = {
        .frames = 3, .width_px = 32, .height_px = 32, .path = (folder / name).string(), .as = as};
    app.frames(2);
    app.key(key::kEnter);
    REQUIRE(app.settle());
    CHECK(state.turntable_open);
    CHECK(std::filesystem::file_size(folder / written) == 4);
    app.press_item("###turntable", {as == TurntableAs::kWebp ? "Replace the file that is there"
                                                             : "Replace the pictures that are there"});
    app.key(key::kEnter);
    REQUIRE(app.settle());
    app.frames(2);
    CHECK_FALSE(state.turntable_open);
    CHECK(std::filesystem::file_size(folder / written) > 4);
    open();
    CHECK_FALSE(state.turntable.overwrite);  // asked anew
  }
}

TEST_CASE(
    "dialogs: a proposed turntable is numbered where a file of its own name exists, not one of another") {
  const ScratchFolder folder("turntable_names");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app, kSmallSample));
  app.studio().apply(Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "apple.ply"}});
  REQUIRE(app.settle());
  std::filesystem::create_directories(folder / "small_sample_turntable");
  UiState& state = app.interface_state();
  const UiRect button = app.button(icon::kFilm);
  app.click(0.5f * (button.min + button.max));
  app.frames(3);
  REQUIRE(state.turntable_open);
  const auto name = [&] { return std::filesystem::path(state.turntable.path).filename().string(); };
  CHECK(name() == "small_sample_turntable_2");
  app.press_item("###turntable", {"Animated WebP"});
  CHECK(name() == "small_sample_turntable.webp");
  std::ofstream(folder / "small_sample_turntable.webp") << "mine";
  app.press_item("###turntable", {"Pictures"});
  CHECK(name() == "small_sample_turntable_2");
  app.press_item("###turntable", {"Animated WebP"});
  CHECK(name() == "small_sample_turntable_2.webp");
  state.turntable.path = (folder / "mine.webp").string();  // typed: it stays
  app.press_item("###turntable", {"Pictures"});
  CHECK(name() == "mine");
}

TEST_CASE("dialogs: leaving while an export is written asks, and Stay lets it be written") {
  const ScratchFolder folder("leave_while_written");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  app.studio().apply(SaveWork{folder / "apple.splatcut.json"});
  REQUIRE(app.settle());
  REQUIRE_FALSE(app.studio().unsaved());
  app.studio().apply(SaveTurntable{folder / "turn", 60, 320, 240});
  REQUIRE(app.studio().exporting());
  app.studio().run(Action::kQuit);
  app.frames(2);
  CHECK_FALSE(app->wants_to_close());
  REQUIRE(app->interface().dialog_open());
  app.key(key::kEscape);
  REQUIRE(app.settle());
  CHECK_FALSE(app->wants_to_close());
  const auto files = std::filesystem::directory_iterator(folder / "turn");
  CHECK(std::distance(begin(files), end(files)) == 60);
  app.studio().run(Action::kQuit);
  app.frames(2);
  CHECK(app->wants_to_close());
}
