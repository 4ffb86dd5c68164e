// Whole frames of the program against stored pictures. SPLATCUT_UPDATE_GOLDENS=1 stores new ones; look at
// them before they are committed. Failures leave NAME.actual.png and NAME.difference.png in the build folder.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

#include "app/work/work_file.h"
#include "app/work/work_picture.h"
#include "core/error.h"
#include "core/picture_difference.h"
#include "core/picture_file.h"
#include "core/png_file.h"
#include "headless_app.h"
#include "keep_drivers_loaded.h"
#include "places.h"
#include "segment/masks/mask_tools.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kLevels = 5;
constexpr double kMostPixels = 0.001;

// The program with the small sample open, drawn by a renderer.
struct DrawnBy {
  explicit DrawnBy(RendererChoice renderer) : app(760, 420, 1, by(renderer)) {
    app.interface_state().hint_wanted = false;
    app.open(kSmallSample);
    REQUIRE(app.settle());
  }
  static ApplicationOptions by(RendererChoice renderer) {
    ApplicationOptions options = with_kept_scenes();
    options.renderer = renderer;
    return options;
  }
  HeadlessApp app;
};

void check_golden(const std::string& name, const Image<Rgb8>& picture) {
  const std::filesystem::path golden =
      std::filesystem::path(project_folder() + "/tests/goldens") / (name + ".png");
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
    const std::filesystem::path folder = build_folder() + "/goldens";
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
  ApplicationOptions options = with_kept_scenes();
  options.sample = kSample;
  HeadlessApp app(1040, 600, 1, options);
  app.frames(3);
  check_golden("start_dark", app.picture());
  app.key('L');
  app.frames(2);
  check_golden("start_light", app.picture());
}

TEST_CASE("frames: left work with its pictures, on the start page and in the panel") {
  const ScratchFolder folder("left_frames");
  Document document;
  add_object(&document, "mug");
  for (const int number : {2, 3}) {
    const auto work = folder / ("autosave." + std::to_string(number) + ".splatcut.json");
    write_work_file(work, *open_scene(kSample), document);
    const auto day =
        std::chrono::sys_days(std::chrono::year(2025) / 3 / number) + std::chrono::seconds(12 * 3600);
    std::filesystem::last_write_time(work, std::chrono::file_clock::from_sys(day));
  }
  Image<Rgb8> picture(kWorkPictureWidthPx, 60, {20, 90, 200});
  for (int y = 40; y < 60; ++y) std::ranges::fill(picture.row(y), Rgb8{60, 160, 60});
  write_work_picture(folder / "autosave.3.splatcut.json", picture);  // the other has none
  ApplicationOptions options = with_state(folder);
  HeadlessApp app(1040, 600, 1, options);
  app.frames(3);
  check_golden("left_work", app.picture());
  app.open(kSample);
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("left_work_panel", app.picture());
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

TEST_CASE("frames: the OpenGL renderer shows what the CPU renderer shows") {
  Image<Rgb8> pictures[2];
  for (const RendererChoice renderer : {RendererChoice::kCpu, RendererChoice::kGl}) {
    DrawnBy drawn(renderer);
    HeadlessApp& app = drawn.app;
    app.studio().apply(EditSelection{SelectionEdit::kAll});  // the tint, too
    ViewState view = app.studio().view();
    view.outline = false;  // drawn with other filters
    app.studio().apply(SetView{view});
    REQUIRE(app.settle());
    app.frames(3);  // the sorter's order arrives
    app.wait_for_message_to_go();
    const UiRect area = app->interface().viewport();
    const Image<Rgb8> frame = app.picture();
    Image<Rgb8>& cut = pictures[static_cast<int>(renderer == RendererChoice::kGl)];
    cut = Image<Rgb8>(static_cast<int>(area.size().x), static_cast<int>(area.size().y));
    for (int y = 0; y < cut.height(); ++y)
      for (int x = 0; x < cut.width(); ++x)
        cut.at(x, y) = frame.at(x + static_cast<int>(area.min.x), y + static_cast<int>(area.min.y));
  }
  const PictureDifference d = picture_difference(pictures[0], pictures[1]);
  MESSAGE("PSNR " << d.psnr_db << " dB, SSIM " << d.ssim);
  CHECK(d.psnr_db > 35);
  CHECK(d.ssim > 0.98);
}

TEST_CASE("frames: OpenGL draws the checker as the CPU does, moving or still, on one pane or two") {
  constexpr int kTop = 84;  // of the picture: below the tool's options and the label
  const auto checker_frame = [](RendererChoice renderer, bool two, bool moving) {
    DrawnBy drawn(renderer);
    HeadlessApp& app = drawn.app;
    Studio& studio = app.studio();
    // A few Gaussians alone: nearly all of the picture is checker.
    Mask spot(studio.viewport().pane_camera().width_px, studio.viewport().pane_camera().height_px);
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x) spot.at(spot.width() / 2 + x, spot.height() / 2 + y) = kMaskObject;
    studio.apply(SelectRegion{studio.viewport().pane_camera(), spot});
    ViewState view = studio.view();
    view.checker = true;
    view.tint = view.outline = false;
    view.display = two ? DisplayMode::kSideBySide : DisplayMode::kIsolate;
    studio.apply(SetView{view});
    REQUIRE(app.settle());
    app.wait_for_message_to_go();
    app.frames(3);
    if (moving) {
      const UiRect view_area = app->interface().viewport();
      app.move(view_area.min + 0.4f * view_area.size());
      app.press(PointerButton::kMiddle);
      for (int i = 0; i < 8; ++i) {
        app.move(view_area.min + 0.4f * view_area.size() + glm::vec2(0.2f * static_cast<float>(i), 0));
        app.frames(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
      CHECK(studio.viewport().moving());
    }
    const UiRect area = app->interface().viewport();
    const Image<Rgb8> frame = app.picture();
    // Above the object and below the labels.
    Image<Rgb8> cut(static_cast<int>(area.size().x) - 120, 40);
    for (int y = 0; y < cut.height(); ++y)
      for (int x = 0; x < cut.width(); ++x)
        cut.at(x, y) = frame.at(x + static_cast<int>(area.min.x), y + static_cast<int>(area.min.y) + kTop);
    return cut;
  };
  const Image<Rgb8> expected = checker_frame(RendererChoice::kCpu, false, false);
  constexpr int kSide = 12;
  for (const auto& [x, y] : {std::pair(1, 0), {11, 11}, {12, 0}, {1, 12}, {12, 12}, {150, 5}}) {
    CAPTURE(x);
    CAPTURE(y);
    const std::uint8_t level = (x / kSide + (y + kTop) / kSide) % 2 == 0 ? 158 : 107;  // 0.62, 0.42 of 255
    CHECK(expected.at(x, y) == Rgb8{level, level, level});
  }
  for (const bool two : {false, true})
    for (const bool moving : {false, true}) {
      const Image<Rgb8> cpu = checker_frame(RendererChoice::kCpu, two, moving),
                        gl = checker_frame(RendererChoice::kGl, two, moving);
      const PictureDifference d = picture_difference(cpu, gl, kLevels);
      CAPTURE(two);
      CAPTURE(moving);
      MESSAGE("two panes ", two, ", moving ", moving, ": ", d.share_beyond, " of the pixels differ");
      if (!moving) CHECK(d.share_beyond == 0);
      if (moving) CHECK(d.psnr_db > 15);  // the CPU's moving picture is smaller, and enlarged
    }
}

namespace {

using ChangedPixels = std::vector<std::uint8_t>;

// The pixels of the picture that `plain` and `styled` show differently.
ChangedPixels changed_by(RendererChoice renderer, const std::function<void(HeadlessApp&)>& objects,
                         const std::function<void(Studio&)>& style) {
  constexpr int kVisible = 10;  // levels
  DrawnBy drawn(renderer);
  HeadlessApp& app = drawn.app;
  objects(app);
  ViewState view = app.studio().view();
  view.tint = view.outline = false;
  app.studio().apply(SetView{view});
  const auto frame = [&] {
    REQUIRE(app.settle());
    app.wait_for_message_to_go();
    app.frames(3);
    return app.picture();
  };
  const Image<Rgb8> plain = frame();
  style(app.studio());
  const Image<Rgb8> styled = frame();
  const UiRect area = app->interface().viewport();
  ChangedPixels changed;
  for (int y = static_cast<int>(area.min.y) + 84; y < static_cast<int>(area.max.y) - 20; ++y)
    for (int x = static_cast<int>(area.min.x) + 5; x < static_cast<int>(area.max.x) - 120; ++x) {
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(plain.at(x, y)[c] - styled.at(x, y)[c]));
      changed.push_back(most > kVisible);
    }
  return changed;
}

// Puts a square of the picture's middle into the active object, `right` pixels from it.
void take_square(Studio& studio, int right) {
  const Camera camera = studio.viewport().pane_camera();
  Mask square(camera.width_px, camera.height_px);
  for (int y = -40; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      square.at(camera.width_px / 2 + right + x, camera.height_px / 2 + y) = kMaskObject;
  studio.apply(SelectRegion{camera, square});
}

}  // namespace

TEST_CASE("frames: OpenGL tints, outlines and highlights what the CPU does, whatever the colours") {
  const auto dark_object = [](HeadlessApp& app) {
    take_square(app.studio(), -30);
    REQUIRE(app.settle());
    app.studio().apply(RecolourObject{app.studio().document().active, {6, 6, 6}});
  };
  const auto touching_objects = [](HeadlessApp& app) {
    take_square(app.studio(), -60);
    REQUIRE(app.settle());
    app.studio().apply(NewObject{});
    take_square(app.studio(), 0);
  };
  const auto shows = [](bool tint, bool outline) {
    return [=](Studio& studio) {
      ViewState view = studio.view();
      view.tint = tint;
      view.outline = outline;
      studio.apply(SetView{view});
    };
  };
  const auto agree = [](const char* what, const auto& objects, const auto& style) {
    CAPTURE(what);
    const ChangedPixels cpu = changed_by(RendererChoice::kCpu, objects, style),
                        gl = changed_by(RendererChoice::kGl, objects, style);
    const double iou = iou_of(cpu, gl);
    MESSAGE(std::string(what) << ": " << std::ranges::count(cpu, 1) << " pixels, IoU " << iou);
    CHECK(std::ranges::count(cpu, 1) > 100);
    CHECK(iou > 0.8);
  };
  agree("the tint of a dark object", dark_object, shows(true, false));
  agree("the outline of a dark object", dark_object, shows(false, true));
  agree("the line between two objects", touching_objects, shows(false, true));
}

TEST_CASE("frames: the sorter of the splats wakes the window when a new order is there") {
  std::atomic<int> wakes = 0;
  ApplicationOptions options = with_kept_scenes();
  options.renderer = RendererChoice::kGl;
  options.studio.wake = [&] { ++wakes; };
  HeadlessApp app(760, 420, 1, options);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  app.frames(3);
  const glm::vec2 at = app->interface().viewport().min + glm::vec2(200, 200);
  app.move(at);
  app.press(PointerButton::kMiddle);
  app.frames(1);
  const int before = wakes;  // while the view moves, no picture is asked for
  app.move(at + glm::vec2(12, 0));
  app.frames(1);
  for (int waited_ms = 0; waited_ms < 5000 && wakes == before; ++waited_ms)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(wakes > before);
  app.release(PointerButton::kMiddle);
}

TEST_CASE("frames: HiDPI") {
  HeadlessApp app(1600, 900, 1.5f);
  app.frames(3);
  check_golden("start_hidpi", app.picture());
}

// The apple by its true labels: a better cut changes no picture.
TEST_CASE("frames: an object tinted, alone, side by side") {
  HeadlessApp app;
  app.open(kSample);
  REQUIRE(app.settle());
  const Scene& scene = *app.studio().scene()->scene;
  const Camera camera = app.studio().viewport().pane_camera();
  app.studio().apply(SelectRegion{
      camera, thresholded(render_labels(scene.cloud, camera, sample_truth(scene, kApple)), 0.5f)});
  app.move({5, 590});  // no hover
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("tinted", app.picture());
  app.key('I');
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("isolated", app.picture());
  app.key('B');
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  check_golden("side_by_side", app.picture());
}

TEST_CASE("frames: the program over EGL without a surface shows what it shows over OSMesa") {
  std::unique_ptr<OffscreenContext> context;
  try {
    context = make_egl_context();
  } catch (const Error& error) {
    MESSAGE("skipped: no EGL context here, " << error.what());
    return;
  }
  keep_drivers_loaded();
  const bool software = current_gl_info().software;
  HeadlessApp app(1040, 600, 1, {}, std::move(context));
  app.open(kSample);
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  const Image<Rgb8> picture = app.picture();
  if (software) return check_golden("sample", picture);
  // A GPU rounds lines and text in its own way, and draws the splats itself.
  const PictureDifference d =
      picture_difference(read_png_rgb(project_folder() + "/tests/goldens/sample.png"), picture);
  MESSAGE("on a GPU: PSNR " << d.psnr_db << " dB");
  CHECK(d.ssim > 0.95);
}
