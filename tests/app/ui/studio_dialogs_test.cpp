// Files and pictures asked for in dialogs: the desktop's own (a stand-in of it), the one inside, the
// turntable.
#include <doctest/doctest.h>

#include <webp/demux.h>

#include <cstdlib>
#include <thread>

#include "core/png_file.h"
#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

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

// Frames until the desktop's dialog has ended.
void wait_for_answer(HeadlessApp& app) {
  for (int i = 0; i < 200; ++i) {
    app.frames(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace

TEST_CASE("dialogs: zenity's answer opens the scene, kdialog's too, and it is asked for the right thing") {
  for (const std::string program : {"zenity", "kdialog"}) {
    CAPTURE(program);
    const ScratchFolder folder("native_" + program);
    const OnlyPath path(folder.path());
    path.put(program, "echo '" + kSample.string() + "'");
    HeadlessApp app(760, 420);
    app.interface_state().native_wanted = true;
    app.key('O', {.ctrl = true});
    wait_for_answer(app);
    CHECK_FALSE(app->interface().dialog_open());
    REQUIRE(app.settle());
    REQUIRE(app.studio().scene());
    CHECK(app.studio().scene()->scene->path == kSample);
    CHECK(path.asked().find(program) != std::string::npos);
    CHECK(path.asked().find("*.splatcut.json") != std::string::npos);
  }
}

TEST_CASE("dialogs: work is saved where the desktop's dialog says, with the ending it needs") {
  const ScratchFolder folder("native_save");
  HeadlessApp app(760, 420);
  app.open(kSample);
  REQUIRE(app.settle());
  const OnlyPath path(folder.path());
  path.put("zenity", "echo '" + (folder / "mine").string() + "'");
  app.interface_state().native_wanted = true;
  app.key('S', {.ctrl = true});
  wait_for_answer(app);
  CHECK(std::filesystem::exists(folder / "mine.splatcut.json"));
  CHECK(path.asked().find("--save\n") != std::string::npos);
}

TEST_CASE(
    "dialogs: a cancelled one changes nothing; one that fails, and none at all, give the built-in one") {
  const ScratchFolder folder("native_none");
  const OnlyPath path(folder.path());
  HeadlessApp app(760, 420);
  app.interface_state().native_wanted = true;
  path.put("zenity", "exit 1");
  app.key('O', {.ctrl = true});
  wait_for_answer(app);
  CHECK_FALSE(app->interface().dialog_open());
  CHECK_FALSE(app.studio().scene());
  path.put("zenity", "exit 255");
  app.key('O', {.ctrl = true});
  wait_for_answer(app);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  app.frames(2);
  CHECK_FALSE(app->interface().dialog_open());
  std::filesystem::remove(folder / "zenity");
  app.key('O', {.ctrl = true});
  app.frames(2);
  CHECK(app->interface().dialog_open());
}

TEST_CASE("dialogs: the turntable writes as many pictures of the size asked for") {
  const ScratchFolder folder("turntable");
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  UiState& state = app.interface_state();
  state.turntable_open = true;
  app.frames(3);
  CHECK(app->interface().dialog_open());
  CHECK(state.turntable.width_px == app.studio().viewport_camera().width_px);
  state.turntable = {5, 96, 64, (folder / "turn").string()};
  app.frames(1);
  app.click({380 + 213, 210 + 106});  // Save
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
    CHECK(save().find("4 frames saved") != std::string::npos);
    CHECK(path.asked().find("-framerate\n2.0000\n") != std::string::npos);
    CHECK(path.asked().find("frame_%04d.png") != std::string::npos);
  }
  std::ifstream in(file);
  std::string text;
  std::getline(in, text);
  CHECK(text == "made");
}
