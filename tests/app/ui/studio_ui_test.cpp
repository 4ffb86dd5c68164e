// The program driven by pointer and keys, without a window.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <functional>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "app/console/camera_options.h"
#include "core/error.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("a click on the apple cuts out the apple, strokes, undo and redo give the same bytes") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  std::vector<Document> states{app.studio().document()};
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const Scene& scene = *app.studio().scene()->scene;
  const double first = iou_of(active_labels(app), sample_truth(scene, kApple));
  MESSAGE("apple, one click: IoU " << first);
  CHECK(first > 0.9);
  CHECK_FALSE(app.studio().cuts().run(app.studio().document().active)->views.empty());
  states.push_back(app.studio().document());

  app.key('3');
  const glm::vec2 at = app.screen_of(kOnApple);
  app.drag({at, at + glm::vec2(6, 6), at + glm::vec2(12, 4)});
  REQUIRE(app.settle());
  states.push_back(app.studio().document());
  CHECK(app.studio().document().active_object()->views.front().strokes.size() == 2);
  app.key('=', {.ctrl = true});  // grow, by hand
  REQUIRE(app.settle());
  states.push_back(app.studio().document());
  REQUIRE_FALSE(same(states.back(), states[2]));

  for (std::size_t i = states.size(); i-- > 1;) {
    app.key('Z', {.ctrl = true});
    REQUIRE(app.settle());
    CHECK(same(app.studio().document(), states[i - 1]));
  }
  CHECK(app.studio().history().cursor() == 0);
  for (std::size_t i = 1; i < states.size(); ++i) {
    app.key('Z', {.shift = true, .ctrl = true});
    REQUIRE(app.settle());
    CHECK(same(app.studio().document(), states[i]));
  }
  CHECK_FALSE(app.studio().history().can_redo());
}

TEST_CASE("two objects: a right click says what is not, the wheel steps through parts, hovering outlines") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  app.move(app.screen_of(kOnMug));
  REQUIRE(app.settle());
  const Flags outlined = app.studio().viewport().style(0).highlight;
  REQUIRE(outlined);
  const Scene& scene = *app.studio().scene()->scene;
  CHECK(iou_of(*outlined, sample_truth(scene, kMug)) > 0.3);
  app.click(app.screen_of(kOnMug));
  REQUIRE(app.settle());
  const std::size_t before = count_flags(active_labels(app));
  app->handle(WheelTurned{-1, {}});
  REQUIRE(app.settle());
  const std::size_t smaller = count_flags(active_labels(app));
  MESSAGE("mug: IoU " << iou_of(active_labels(app), sample_truth(scene, kMug))
                      << " after a step down; Gaussians " << before << " -> " << smaller);
  CHECK(smaller < before);
  app.key('Z', {.ctrl = true});
  REQUIRE(app.settle());
  CHECK(count_flags(active_labels(app)) == before);

  app.key('N', {.ctrl = true});
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  REQUIRE(app.studio().document().objects.size() == 2);
  CHECK(iou_of(active_labels(app), sample_truth(scene, kOrange)) > 0.9);
  app.click(app.screen_of(kOnApple), PointerButton::kRight);  // it is no part of the orange, and was none
  REQUIRE(app.settle());
  CHECK(app.studio().document().active_object()->views.front().strokes.back().label == SeedLabel::kRest);
  CHECK(iou_of(active_labels(app), sample_truth(scene, kOrange)) > 0.9);
}

TEST_CASE("cancel: in every stage the strokes stay, nothing half done is left, and R computes again") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  const glm::vec2 apple = app.screen_of(kOnApple);
  const auto run = [&] { return app.studio().cuts().run(app.studio().document().active); };
  const std::pair<const char*, std::function<bool()>> stages[] = {
      {"as it begins", [&] { return app.studio().cutting(); }},
      {"with the first labels", [&] { return run() && run()->preview; }},
      {"after the cut", [&] { return app.studio().progress().stage == "pictures of the views"; }}};
  constexpr int kMostFrames = 2000;
  int stages_reached = 0;
  for (const auto& [name, reached] : stages) {
    CAPTURE(name);
    app.click(apple);
    bool was_reached = reached();
    for (int i = 0; i < kMostFrames && !was_reached && !app.studio().idle(); ++i) {
      app.frames(1);
      was_reached = reached();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    stages_reached += was_reached;
    app.key(key::kEscape);
    REQUIRE(app.settle());
    const ObjectItem& object = *app.studio().document().active_object();
    CHECK(object.views.front().strokes.size() == 1);
    CHECK_FALSE((run() && run()->running));
    if (!object.cut) CHECK(count_flags(active_labels(app)) == 0);
    app.studio().apply(Undo{});
    app.studio().apply(SetView{});
    REQUIRE(app.settle());
  }
  CHECK(stages_reached >= 2);  // one may be over before a frame sees it
  app.click(apple);
  app.frames(1);
  app.key(key::kEscape);
  REQUIRE(app.settle());
  app.key('R');
  REQUIRE(app.settle());
  CHECK(iou_of(active_labels(app), sample_truth(*app.studio().scene()->scene, kApple)) > 0.9);
}

TEST_CASE("after a click, views around the object are there to look from, and have no say") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const auto& views = app.studio().cuts().run(app.studio().document().active)->views;
  REQUIRE(views.size() > 3);
  CHECK_FALSE(views.front().only_to_look);
  CHECK(views.front().used);
  for (std::size_t i = 1; i < views.size(); ++i) {
    CHECK(views[i].only_to_look);
    CHECK_FALSE(views[i].used);
    CHECK(views[i].picture);
  }
}

TEST_CASE(
    "a scene without cameras: the commands stand where the window opens it, whatever is up in the file") {
  const ScratchFolder folder("no_cameras");
  Scene scene = load_scene(kSample);
  const glm::quat stood_up = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0));  // -y to +z
  for (glm::vec3& p : scene.cloud.position) p = stood_up * p;
  for (glm::quat& q : scene.cloud.rotation) q = stood_up * q;
  const auto file = folder / "turned.splat";
  save_scene(file, scene, {}, SceneFormat::kSplat);
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(file);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  CHECK(app.studio().scene()->views().cameras.empty());
  const Camera window = app.studio().viewport().pane_camera();
  CameraOptions options;
  options.size = fmt::format("{}x{}", window.width_px, window.height_px);
  const ChosenCamera chosen = choose_camera(options, *app.studio().scene()->scene);
  CHECK(glm::distance(chosen.up_world, glm::vec3(0, 0, 1)) < 1e-6f);
  CHECK(glm::distance(chosen.camera.centre_world(), window.centre_world()) < 1e-3f);
  CHECK(glm::distance(chosen.camera.forward_world(), window.forward_world()) < 1e-4f);
  CHECK(glm::distance(chosen.camera.down_world(), window.down_world()) < 1e-4f);
  CHECK(chosen.camera.fy_px == doctest::Approx(window.fy_px).epsilon(1e-4));

  options.position = "0,0,5", options.target = "0,0,0";  // straight down: the guess must not refuse it
  CHECK_NOTHROW(choose_camera(options, scene));
  options.up = "0,0,1";
  CHECK_THROWS_AS(choose_camera(options, scene), Error);
}
