// Times of the window without a window: pictures, longest frame during a cut, click to cutout.
// Usage: splatcut_window_bench SCENE X Y [keys|answers]   X, Y: the object in the first camera's view, else
// in that opened, in shares of width and height. keys: only the times from a key to its picture, once the
// object is cut out. answers: only from opening to the first answers, with their CPU time and memory.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <functional>

#include "../tests/headless_app.h"
#include "core/ranks.h"
#include "core/stage_clock.h"
#include "cpu_clock.h"

// Where the sample lies, as the tests' headers ask.
std::string splatcut::testing::project_folder() {
  return SPLATCUT_SOURCE_DIR;
}

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Clock = std::chrono::steady_clock;

void print(const char* what, double ms) {
  fmt::print("{:<44} {:8.1f} ms\n", what, ms);
}

void print(const char* what, const FrameTimes& t) {
  fmt::print("{:<44} {:8.1f} ms (update {:.1f}, interface {:.1f}, draw {:.1f}, requests {:.1f})\n", what,
             t.total(), t.update, t.interface, t.draw, t.requests);
}

// Frames in real time until idle; ms until `reached`, and the longest frame.
template <class Reached>
double until(HeadlessApp& app, const Reached& reached, FrameTimes* longest) {
  const auto start = Clock::now();
  auto before = start;
  double reached_ms = -1;
  int quiet = 0;
  while (quiet < 3) {
    const auto now = Clock::now();
    app->frame(std::chrono::duration<double>(now - before).count());
    glFinish();  // as showing it would
    if (const FrameTimes times = app->take_longest(); times.total() > longest->total()) *longest = times;
    before = now;
    if (reached_ms < 0 && reached()) reached_ms = ms_since(start);
    quiet = app.studio().idle() ? quiet + 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  return reached_ms;
}

void moving_pictures(HeadlessApp& app) {
  Studio& s = app.studio();
  const UiRect view = app->interface().viewport();
  const glm::vec2 middle = 0.5f * (view.min + view.max);
  app.move(middle);
  app.press(PointerButton::kMiddle);
  constexpr double kSeconds = 6;
  const auto start = Clock::now();
  auto before = start;
  std::uint64_t serial = s.viewport().picture_serial();
  int pictures = 0, frames = 0;
  while (ms_since(start) < 1000 * kSeconds) {
    const auto now = Clock::now();
    app.move(middle + glm::vec2(static_cast<float>(frames % 200), 0));
    app->frame(std::chrono::duration<double>(now - before).count());
    glFinish();  // as showing it would
    before = now;
    ++frames;
    if (s.viewport().picture_serial() != serial && ms_since(start) > 1500) ++pictures;
    serial = s.viewport().picture_serial();
  }
  app.release(PointerButton::kMiddle);
  fmt::print("{:<44} {:8.1f} pictures/s at {:.0f} % size, {:.1f} frames/s of the interface\n", "moving",
             pictures / (kSeconds - 1.5), 100 * s.viewport().moving_scale(), frames / kSeconds);
  print("moving, one picture", s.viewport().moving_ms());
}

// Wall and CPU time from here on; the interface is not drawn meanwhile.
class Stretch {
 public:
  void print(const char* what) const {
    fmt::print("{:<44} {:8.2f} s, CPU {:.2f} s\n", what, ms_since(start_) / 1000,
               bench::cpu_seconds() - cpu_start_s_);
  }

 private:
  Clock::time_point start_ = Clock::now();
  double cpu_start_s_ = bench::cpu_seconds();
};

template <class Reached>
void update_until(Studio& s, const Reached& reached) {
  constexpr double kMostMs = 300'000;
  for (const auto start = Clock::now(); !reached();) {
    if (ms_since(start) > kMostMs) {
      fmt::print(stderr, "what is timed did not happen within five minutes\n");
      std::exit(1);
    }
    s.update(1.0 / 60);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::size_t peak_mib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) / 1024;
}

// From a file to what clicks give, each as soon as it can be asked for, so that nothing was computed before.
void time_answers(HeadlessApp& app, const std::string& scene, const glm::vec2& share) {
  Studio& s = app.studio();
  const Stretch opening;
  app.open(scene);
  update_until(s, [&] { return s.scene() != nullptr; });
  app.frames(1);  // which lays out the panes
  update_until(s, [&] { return s.viewport().picture() != nullptr; });
  opening.print("open to first picture");
  if (const auto& cameras = s.scene()->views().cameras; !cameras.empty()) s.camera().go_to(cameras.front());
  s.camera().finish_transition();
  const auto pictured = [&] { return s.viewport().full_picture_of(s.viewport().pane_camera()); };
  update_until(s, pictured);
  opening.print("open to still picture of the first view");
  fmt::print("{} Gaussians, peak {} MiB\n", s.scene()->cloud->size(), peak_mib());
  const Camera camera = s.viewport().pane_camera();
  const glm::vec2 at = share * glm::vec2(camera.width_px, camera.height_px);
  const auto run = [&]() -> const CutRun* { return s.cuts().run(s.document().active); };
  const auto press = [&](const glm::vec2& pixel) {
    s.pointer_pressed(pixel, PointerButton::kLeft, {});
    s.pointer_released(pixel, PointerButton::kLeft, {});
  };
  const auto cut_out = [&] { return run() && !run()->running && run()->total_ms > 0; };
  const Stretch click;
  press(at);
  update_until(s, [&] { return run() && run()->first_mask_ms > 0; });
  click.print("click to first answer");
  update_until(s, cut_out);
  click.print("click to cutout");
  fmt::print("  {} Gaussians, peak {} MiB\n", s.gaussians_of(s.document().active), peak_mib());
  for (const StageTime& stage : run()->stages) fmt::print("  {:<42} {:8.1f} ms\n", stage.name, stage.ms);
  const auto rested = [&] { return s.idle(); };
  update_until(s, rested);
  click.print("click to rest");
  for (const float away_px : {12.0f, 60.0f}) {
    const Stretch hover;
    s.pointer_moved(at + glm::vec2(away_px, 0.5f * away_px), {});
    update_until(s, [&] { return !s.idle(); });
    update_until(s, rested);
    hover.print(fmt::format("hover {} px away", away_px).c_str());
  }
  const Stretch stroke;
  press(at + glm::vec2(12, 6));
  update_until(s, [&] { return run() && run()->running; });
  update_until(s, cut_out);
  stroke.print("next click, to cutout");
  fmt::print("  {} Gaussians, peak {} MiB\n", s.gaussians_of(s.document().active), peak_mib());
}

// How long the window's thread stands still at the worst, from the command until everything is at rest.
double longest_stop(HeadlessApp& app, const std::function<void()>& command) {
  Studio& s = app.studio();
  double longest = 0;
  const auto timed = [&longest](const auto& work) {
    const auto start = Clock::now();
    work();
    longest = std::max(longest, ms_since(start));
  };
  timed(command);
  for (int quiet = 0; quiet < 3; quiet = s.idle() ? quiet + 1 : 0) {
    timed([&s] { s.update(1.0 / 60); });
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return longest;
}

void stops_of_commands(HeadlessApp& app, const glm::vec2& at) {
  Studio& s = app.studio();
  const glm::vec2 size(s.viewport().pane_camera().width_px, s.viewport().pane_camera().height_px);
  const glm::vec2 pixel = at * size;
  const auto hit = s.viewport().pick(pixel);
  if (!hit) return;
  const float reach = 0.2f * s.camera().scene_size();
  const auto report = [&](const char* what, const std::function<void()>& command) {
    print(what, longest_stop(app, command));
  };
  const auto change_view = [&s](const auto& change) {
    ViewState view = s.view();
    change(view);
    s.apply(SetView{view});
  };
  fmt::print("longest stop of the window's thread, from the command to rest:\n");
  report("  new object", [&] { s.apply(NewObject{}); });
  report("  select a sphere in space", [&] {
    s.apply(SelectVolume{Volume{true, hit->position_world, glm::vec3(reach)}, SetOperation::kAdd, false});
  });
  report("  grow", [&] { s.apply(EditSelection{SelectionEdit::kGrow}); });
  report("  shrink", [&] { s.apply(EditSelection{SelectionEdit::kShrink}); });
  report("  show floaters", [&] { s.apply(ShowFloaters{true}); });
  report("  remove floaters", [&] { s.apply(EditSelection{SelectionEdit::kRemoveFloaters}); });
  report("  hide floaters", [&] { s.apply(ShowFloaters{false}); });
  report("  largest part", [&] { s.apply(EditSelection{SelectionEdit::kLargestPart}); });
  report("  invert", [&] { s.apply(EditSelection{SelectionEdit::kInvert}); });
  report("  undo", [&] { s.apply(Undo{}); });
  report("  isolate", [&] { change_view([](ViewState& v) { v.display = DisplayMode::kIsolate; }); });
  report("  whole", [&] { change_view([](ViewState& v) { v.display = DisplayMode::kWhole; }); });
  report("  tint off", [&] { change_view([](ViewState& v) { v.tint = !v.tint; }); });
  report("  select by colour", [&] { s.apply(PickColour{hit->gaussian, SetOperation::kAdd}); });
  report("  select flood", [&] { s.apply(SelectFlood{hit->gaussian, SetOperation::kAdd}); });
  report("  select by size", [&] { s.apply(SelectRange{Property::kSize, -2, -1, SetOperation::kRemove}); });
  const Mask region =
      rectangle_region(0.3f * size, 0.6f * size, static_cast<int>(size.x), static_cast<int>(size.y));
  report("  select in the picture", [&] {
    s.apply(SelectRegion{s.viewport().pane_camera(), region, SetOperation::kAdd});
  });
  change_view([](ViewState& v) { v.see_through = true; });
  report("  select through the scene", [&] {
    s.apply(SelectRegion{s.viewport().pane_camera(), region, SetOperation::kAdd});
  });
  change_view([](ViewState& v) { v.see_through = false; });
  report("  delete", [&] { s.apply(DeleteSelected{}); });
  report("  undo", [&] { s.apply(Undo{}); });
  report("  rename", [&] { s.apply(RenameObject{s.document().active, "another"}); });
  report("  point under the pointer, view just moved", [&] {
    s.camera().orbit({3, 0});
    s.viewport().pick(pixel);
  });
  report("  double click, view just moved", [&] {
    s.camera().orbit({3, 0});
    s.pointer_double_clicked(pixel);
  });
  report("  frame the object", [&] { s.run(Action::kFrameObject); });
}

// From a key to the first picture that shows what it asks for, and to the still picture at full size.
// drawing: the time of that picture alone.
struct KeyTimes {
  std::vector<float> shown_ms, still_ms, drawing_ms;
};

void time_key(HeadlessApp& app, int key, KeyTimes* times) {
  Studio& s = app.studio();
  const std::uint64_t picture = s.viewport().picture_serial();
  const std::size_t taken = s.gaussians_of(s.document().active);
  const auto start = Clock::now();
  auto before = start;
  double shown_ms = -1, still_ms = -1;
  bool asked = false;  // the panes hold what the key asks for
  std::uint64_t behind = picture;
  app->handle(KeyChanged{key, true, false, {}});
  const bool steps = key == key::kPageUp || key == key::kPageDown;
  while (still_ms < 0 && ms_since(start) < 60000) {
    const auto now = Clock::now();
    app->frame(std::chrono::duration<double>(now - before).count());
    glFinish();  // as showing it would
    before = now;
    const bool done = !steps || s.gaussians_of(s.document().active) != taken;
    if (!asked && done && s.viewport().display_current() && s.viewport().style_current()) {
      asked = true;
      behind = s.viewport().picture_serial() - (s.viewport().picture_serial() != picture ? 1 : 0);
    }
    if (asked && shown_ms < 0 && s.viewport().picture_serial() > behind) shown_ms = ms_since(start);
    if (shown_ms >= 0 && s.viewport().idle()) still_ms = ms_since(start);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  app->handle(KeyChanged{key, false, false, {}});
  times->shown_ms.push_back(static_cast<float>(shown_ms));
  times->still_ms.push_back(static_cast<float>(still_ms));
  times->drawing_ms.push_back(static_cast<float>(s.viewport().still_ms()));
}

void rest(HeadlessApp& app) {
  FrameTimes ignored;
  until(
      app, [] { return true; }, &ignored);
}

void print(const char* what, KeyTimes times) {
  fmt::print("{:<44} {:8.2f} s, still {:.2f} s, of which drawing {:.2f} s ({} times)\n", what,
             median(times.shown_ms) / 1000, median(times.still_ms) / 1000, median(times.drawing_ms) / 1000,
             times.shown_ms.size());
}

// Each key once from rest, and as many times as makes a median. Keys that come in pairs go back in between.
void keys_to_pictures(HeadlessApp& app) {
  constexpr int kTimes = 5;
  KeyTimes ignored;
  Studio& s = app.studio();
  const Camera from = s.viewport().pane_camera();
  fmt::print("from a key to its picture, medians:\n");
  const auto report = [&](const char* what, const char* back, int key, int back_key) {
    KeyTimes there, again;
    for (int i = 0; i < kTimes; ++i) {
      rest(app);
      time_key(app, key, &there);
      rest(app);
      time_key(app, back_key, &again);
    }
    rest(app);
    print(what, there);
    print(back, again);
  };
  report("  I, the object alone", "  I, back", 'I', 'I');
  report("  H, without the object", "  H, back", 'H', 'H');
  report("  B, side by side", "  B, back", 'B', 'B');
  time_key(app, 'I', &ignored);
  report("  B of the object alone, before and after", "  B, back", 'B', 'B');
  time_key(app, 'I', &ignored);
  KeyTimes framed;
  for (int i = 0; i < kTimes; ++i) {
    s.camera().go_to(from);
    s.camera().finish_transition();
    rest(app);
    time_key(app, 'F', &framed);
  }
  print("  F, a transition of the view in it", framed);
  report("  Page Up, the next size", "  Page Down, back", key::kPageUp, key::kPageDown);
}

void gl_pictures(const std::shared_ptr<const GaussianCloud>& cloud, const Camera& camera) {
  GlSplats splats;
  splats.upload(*cloud);
  auto start = Clock::now();
  const DepthOrder order = depth_order(cloud, camera);
  print("OpenGL: depth order", ms_since(start));
  splats.upload_order(order.back_to_front);
  splats.draw(camera);
  glFinish();
  start = Clock::now();
  splats.draw(camera);
  splats.resolve({});
  glFinish();
  print("OpenGL here: one picture", ms_since(start));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view only = argc > 4 ? argv[4] : "";
  const glm::vec2 share(argc > 3 ? std::atof(argv[2]) : 0, argc > 3 ? std::atof(argv[3]) : 0);
  const bool inside = share.x > 0 && share.y > 0 && share.x < 1 && share.y < 1;
  if (!inside || argc > 5 || !(only.empty() || only == "keys" || only == "answers")) {
    fmt::print(
        stderr,
        "splatcut_window_bench SCENE X Y [keys|answers]   X, Y: shares of the picture, between 0 and 1\n");
    return 2;
  }
  const bool only_keys = only == "keys";
  HeadlessApp app(1280 + 370, 720 + 76);  // a picture of 1280x720
  if (only == "answers") {
    time_answers(app, argv[1], share);
    return 0;
  }
  Studio& s = app.studio();
  FrameTimes longest;
  const auto start = Clock::now();
  app.open(argv[1]);
  while (!s.viewport().picture() && ms_since(start) < 100000) {
    app->frame(1.0 / 60);
    glFinish();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // as a screen would hold it up
  }
  print("open to first picture", ms_since(start));
  const Camera camera = s.viewport().pane_camera();
  fmt::print("{} Gaussians, picture {}x{}\n", s.scene()->cloud->size(), camera.width_px, camera.height_px);
  print("still picture", s.viewport().still_ms());
  if (!only_keys) moving_pictures(app);
  s.camera().go_to(s.scene()->views().cameras.empty() ? camera : s.scene()->views().cameras.front());
  s.camera().finish_transition();
  until(
      app, [] { return true; }, &longest);
  const UiRect view = app->interface().viewport();
  const glm::vec2 at = view.min + share * view.size();
  longest = {};
  app.move(at);
  until(
      app, [] { return true; }, &longest);
  print("hover: longest frame", longest);
  longest = {};
  const auto run = [&]() -> const CutRun* { return s.cuts().run(s.document().active); };
  const auto done = [&] { return run() && !run()->running && run()->total_ms > 0; };
  app.move(at);
  app.press(PointerButton::kLeft);
  app.release(PointerButton::kLeft);
  const double cutout = until(app, done, &longest);
  print("click to first mask", run()->first_mask_ms);
  print("click to cutout", cutout);
  print("  longest frame meanwhile", longest);
  fmt::print("  {} Gaussians\n", s.gaussians_of(s.document().active));
  for (const StageTime& stage : run()->stages) fmt::print("  {:<42} {:8.1f} ms\n", stage.name, stage.ms);
  keys_to_pictures(app);
  if (only_keys) return 0;
  longest = {};
  ViewState scribbling = s.view();  // a key would choose another meaning of the click
  scribbling.tool = ToolId::kScribble;
  s.apply(SetView{scribbling});
  app.move(at);
  app.press(PointerButton::kLeft);
  app.move(at + glm::vec2(9, 5));
  app.release(PointerButton::kLeft);
  print("stroke in the same view to cutout", until(app, done, &longest));
  print("  to its first mask", run()->first_mask_ms);
  s.camera().orbit({60, 0});
  until(
      app, [] { return true; }, &longest);
  app.move(at);
  app.press(PointerButton::kLeft);
  app.move(at + glm::vec2(9, 5));
  app.release(PointerButton::kLeft);
  print("stroke in another view to cutout", until(app, done, &longest));
  s.apply(SetSmoothness{s.document().active, 2.5f});
  until(app, done, &longest);
  s.apply(SetSmoothness{s.document().active, 2.7f});
  print("slider to cutout", until(app, done, &longest));
  stops_of_commands(app, share);
  gl_pictures(s.scene()->cloud, camera);
}
