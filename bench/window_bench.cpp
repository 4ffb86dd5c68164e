// Times of the window without a window: pictures, longest frame during a cut, click to cutout.
// Usage: splatcut_window_bench SCENE X Y   X, Y: the object in the view as opened, in shares of width and
// height.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "../tests/headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

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
  std::uint64_t serial = s.picture_serial();
  int pictures = 0, frames = 0;
  while (ms_since(start) < 1000 * kSeconds) {
    const auto now = Clock::now();
    app.move(middle + glm::vec2(static_cast<float>(frames % 200), 0));
    app->frame(std::chrono::duration<double>(now - before).count());
    glFinish();  // as showing it would
    before = now;
    ++frames;
    if (s.picture_serial() != serial && ms_since(start) > 1500) ++pictures;
    serial = s.picture_serial();
  }
  app.release(PointerButton::kMiddle);
  fmt::print("{:<44} {:8.1f} pictures/s at {:.0f} % size, {:.1f} frames/s of the interface\n", "moving",
             pictures / (kSeconds - 1.5), 100 * s.moving_scale(), frames / kSeconds);
  print("moving, one picture", s.moving_ms());
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
  if (argc < 4) return 2;
  const glm::vec2 share(std::atof(argv[2]), std::atof(argv[3]));
  if (!(share.x > 0 && share.y > 0 && share.x < 1 && share.y < 1)) {
    fmt::print(stderr, "X and Y are shares of the picture between 0 and 1\n");
    return 2;
  }
  HeadlessApp app(1280 + 370, 720 + 76);  // a picture of 1280x720
  Studio& s = app.studio();
  FrameTimes longest;
  const auto start = Clock::now();
  app.open(argv[1]);
  while (!s.picture() && ms_since(start) < 100000) app.frames(1);
  print("open to first picture", ms_since(start));
  until(
      app, [&] { return s.prepared() != nullptr; }, &longest);
  print("open to prepared", ms_since(start));
  const Camera camera = s.viewport_camera();
  fmt::print("{} Gaussians, picture {}x{}\n", s.scene()->cloud->size(), camera.width_px, camera.height_px);
  print("still picture, while preparing", s.still_ms());
  s.camera().orbit({1, 0});
  until(
      app, [] { return true; }, &longest);
  print("still picture, prepared", s.still_ms());
  s.camera().orbit({-1, 0});
  until(
      app, [] { return true; }, &longest);
  moving_pictures(app);
  s.camera().go_to(s.scene()->cameras.empty() ? camera : s.scene()->cameras.front());
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
  const auto run = [&]() -> const CutRun* { return s.cut_run(s.document().active); };
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
  longest = {};
  app.key('3');
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
  gl_pictures(s.scene()->cloud, camera);
}
