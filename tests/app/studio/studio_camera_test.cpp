// The camera as hands expect it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <nlohmann/json.hpp>

#include "app/ui/panels.h"
#include "hands.h"
#include "opened_sample.h"
#include "scene/cloud/strays.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: +Z up comes back with the view, and pressed again sets a leaning view upright") {
  const ScratchFolder folder("up");
  Hands hands;
  const auto upright = [&] {
    const glm::vec3 right = glm::row(glm::mat3_cast(hands.studio().camera().pose().camera_from_world), 0);
    return std::abs(glm::dot(right, hands.studio().document().up_world)) < 1e-3f;
  };
  hands.studio().apply(SetUp{{0, 0, 1}});
  REQUIRE(hands.app.settle());
  CHECK(upright());
  const CameraPose pose = hands.studio().camera().kept_pose();
  hands.studio().apply(SaveWork{folder / "up.splatcut.json"});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{folder / "up.splatcut.json"});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().document().up_world == glm::vec3(0, 0, 1));
  CHECK(hands.studio().camera().up_world() == glm::vec3(0, 0, 1));
  CHECK(hands.studio().camera().pose() == pose);
  CameraPose leaning = pose;
  leaning.camera_from_world = glm::angleAxis(0.4f, glm::vec3(0, 0, 1)) * pose.camera_from_world;
  hands.studio().camera().set_pose(leaning);
  REQUIRE_FALSE(upright());
  hands.studio().apply(SetUp{{0, 0, 1}});
  REQUIRE(hands.app.settle());
  CHECK(upright());
}

TEST_CASE("hands: where a click was from too far away, one comes nearer to what was clicked") {
  Hands hands(false);
  const glm::vec3 apple = hands.under(hands.app.screen_of(kOnApple));
  hands.studio().camera().zoom(-45, apple);
  REQUIRE(hands.app.settle());
  hands.app.click(hands.seen_at(apple));
  REQUIRE(hands.app.settle());
  REQUIRE(hands.said().ends_with("come nearer"));
  const float far = glm::distance(hands.studio().camera().pose().position_world, apple);
  hands.app.press_item("side/scroll", {"Come nearer"});
  REQUIRE(hands.app.settle());
  const float near = glm::distance(hands.studio().camera().pose().position_world, apple);
  CHECK(near < 0.4f * far);
  CHECK(glm::distance(hands.seen_at(apple), hands.app->interface().viewport().min +
                                                0.5f * hands.app->interface().viewport().size()) < 30);
  hands.app.press_item("side/scroll", {"Come nearer"});  // still there: nothing was clicked from here
  REQUIRE(hands.app.settle());
  hands.app.click(hands.seen_at(apple));
  REQUIRE(hands.app.settle());
  const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
  CHECK(std::ranges::none_of(run->doubts, [](const auto& d) { return d.ends_with("come nearer"); }));
  CHECK(hands.said().find("first view") == std::string::npos);
}

TEST_CASE("hands: one comes nearer to a stroke that begins outside of the picture, or is told why not") {
  Hands hands(false);
  const glm::vec2 apple = hands.in_viewport(hands.app.screen_of(kOnApple));
  const glm::vec3 eye = hands.studio().camera().pose().position_world;
  hands.studio().apply(
      AddStroke{hands.studio().viewport().pane_camera(), {SeedLabel::kObject, 2, {{-40, 100}, apple}}});
  REQUIRE(hands.studio().document().active_object());
  hands.studio().apply(ComeNearer{});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().camera().pose().position_world != eye);
  const ScratchFolder folder("outside");
  hands.studio().apply(SaveWork{folder / "in.splatcut.json"});
  REQUIRE(hands.app.settle());
  std::ifstream in(folder / "in.splatcut.json");
  auto work = nlohmann::json::parse(in);
  work["objects"][0]["views"][0]["strokes"][0]["points"] = {{-40, 100}};
  std::ofstream(folder / "out.splatcut.json") << work;
  hands.studio().apply(OpenScene{folder / "out.splatcut.json"});
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().document().active_object());
  hands.studio().apply(ComeNearer{});
  CHECK(hands.said() == "There is nothing in that place.");
}

TEST_CASE("hands: from straight above the view turns on without tipping over, however it leaned before") {
  for (const float lean : {0.0f, 0.4f, glm::half_pi<float>()}) {
    CAPTURE(lean);
    const glm::vec3 up = glm::normalize(glm::vec3(0.2f, -1, 0.1f));
    CameraController camera;
    camera.reset({glm::vec3(-1), glm::vec3(1)}, up);
    for (int step = 0; step < 60; ++step) {
      CameraPose pose = camera.pose();
      pose.camera_from_world = glm::angleAxis(lean, glm::vec3(0, 0, 1)) * pose.camera_from_world;
      camera.set_pose(pose);
      camera.look_along(-up);
      camera.finish_transition();
      const auto axis = [&](int i) { return glm::row(glm::mat3_cast(camera.pose().camera_from_world), i); };
      CHECK(glm::dot(axis(2), up) < -0.999f);
      CHECK(std::abs(glm::dot(axis(0), up)) < 1e-4f);
      for (const float dy : {3.0f, -2.0f, 5.0f, -20.0f}) {
        camera.orbit({7, dy});
        CHECK(-glm::dot(axis(1), up) > 0);
      }
    }
  }
}

TEST_CASE("hands: a camera of the capture that looks straight down turns without tipping over") {
  CameraController camera;
  const glm::vec3 up(0, -1, 0);
  camera.reset({glm::vec3(-1), glm::vec3(1)}, up);
  CameraPose pose = camera.pose();
  for (int step = 0; step < 24; ++step) {  // each turned by another angle, exactly at the pole
    pose.camera_from_world =
        glm::normalize(glm::angleAxis(0.26f * static_cast<float>(step), glm::vec3(0, 0, 1)) *
                       glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0)));
    camera.set_pose(pose);
    const auto axis = [&](int i) { return glm::row(glm::mat3_cast(camera.pose().camera_from_world), i); };
    REQUIRE(std::abs(glm::dot(axis(2), up)) > 0.9999f);
    camera.orbit({0, 4});
    CHECK(-glm::dot(axis(1), up) > 0);
  }
}

TEST_CASE(
    "hands: many turns of the wheel at once, before a picture is drawn, stay in front of what is meant") {
  Hands hands(false);
  hands.studio().set_gpu_view(true);  // which draws no picture while the view moves
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  const glm::vec3 point = hands.under(at);
  hands.app.move(at);
  const auto depth = [&] { return hands.studio().viewport().pane_camera().camera_from_world(point).z; };
  const float before = depth();
  for (int i = 0; i < 12; ++i) {
    hands.app->handle(WheelTurned{1, {}});
    hands.app.frames(1);
  }
  CHECK(depth() > 0);
  CHECK(depth() == doctest::Approx(before * std::pow(0.88f, 12.0f)).epsilon(0.02));
  CHECK(glm::distance(hands.seen_at(point), at) < 2);
}

TEST_CASE("hands: what is under the pointer stays there while the wheel goes nearer and a drag shifts") {
  Hands hands(false);
  hands.app.key('1');
  for (const glm::vec2& pixel : {kOnApple, kOnMug}) {
    const glm::vec2 at = hands.app.screen_of(pixel);
    hands.studio().apply(GoToCamera{hands.studio().scene()->views().cameras.front()});
    REQUIRE(hands.app.settle());
    const glm::vec3 point = hands.under(at);
    const float before = glm::distance(hands.studio().camera().pose().position_world, point);
    hands.app.move(at);
    hands.app->handle(WheelTurned{3, {}});
    CHECK(glm::distance(hands.seen_at(point), at) < 1.5f);
    CHECK(glm::distance(hands.studio().camera().pose().position_world, point) < 0.75f * before);
    REQUIRE(hands.app.settle());
    const glm::vec2 to = at + glm::vec2(60, -35);
    hands.app.drag({at, at + glm::vec2(30, -10), to}, PointerButton::kRight);
    CHECK(glm::distance(hands.seen_at(point), to) < 4);
  }
}

TEST_CASE("hands: the view turns around what was clicked") {
  Hands hands;
  hands.app.key('1');
  const glm::vec3 apple = hands.under(hands.app.screen_of(kOnApple));
  const glm::vec2 before = hands.seen_at(apple);
  REQUIRE(glm::distance(before, hands.app->interface().viewport().min +
                                    0.5f * hands.app->interface().viewport().size()) > 40);
  hands.app.drag({{300, 120}, {360, 120}, {420, 120}}, PointerButton::kMiddle);
  CHECK(glm::distance(hands.seen_at(apple), before) < 3);
}

TEST_CASE("hands: F frames the object in what thumbnails leave free") {
  Hands hands;
  REQUIRE(hands.app->interface().covered_bottom(hands.studio()) > 0);
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const UiRect view = hands.app->interface().viewport();
  const float lowest = view.max.y - hands.app->interface().covered_bottom(hands.studio());
  std::size_t inside = 0, all = 0;
  float top = 1e9f, bottom = -1e9f;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (!labels[g]) continue;
    const glm::vec2 at = hands.seen_at(cloud.position[g]);
    ++all;
    const bool free = view.contains(at) && at.y < lowest;
    inside += free;
    if (free) top = std::min(top, at.y), bottom = std::max(bottom, at.y);
  }
  CHECK(static_cast<double>(inside) > 0.97 * static_cast<double>(all));
  CHECK(bottom - top > 0.4f * (lowest - view.min.y));
}

namespace {

// The share of the active object's pixels that the rest of the scene covers in the present view.
double covered_share(Hands& hands) {
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const Camera camera = limited_to_width(hands.studio().viewport().pane_camera(), 200);
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const Mask seen = thresholded(render_labels({cloud, nullptr}, camera, labels), 0.5f);
  RasterOptions alone;
  alone.shown = labels;
  const Mask whole = thresholded(rasterize(cloud, camera, alone).alpha, 0.5f);
  return 1 - static_cast<double>(count(seen)) / static_cast<double>(count(whole));
}

}  // namespace

TEST_CASE("hands: where something stands before the object, F again looks from a side where less does") {
  Hands hands;
  Studio& studio = hands.studio();
  const auto frame = [&] {
    hands.app.key('F');
    REQUIRE(hands.app.settle());
    return studio.camera().pose();
  };
  frame();
  CHECK(hands.said().find("F again") == std::string::npos);
  CameraPose worst = studio.camera().pose();
  double most = 0;
  for (int turn = 0; turn < 24; ++turn) {
    studio.camera().orbit(
        {turn == 0 ? 0.0f : 43.6f, turn == 0 ? -60.0f : 0.0f});  // 15 degrees, low above the table
    if (const double covered = covered_share(hands); covered > most) {
      most = covered;
      worst = studio.camera().pose();
    }
  }
  REQUIRE(most > 0.4);
  studio.camera().set_pose(worst);
  REQUIRE(hands.app.settle());
  const CameraPose first = frame();
  const double before = covered_share(hands);
  REQUIRE(before > 0.3);
  CHECK(hands.said().find("Something stands before Object 1: F again") == 0);
  const glm::vec3 forward = studio.viewport().pane_camera().forward_world();
  CHECK(frame() != first);
  CHECK(covered_share(hands) < before - 0.1);
  CHECK(glm::dot(studio.viewport().pane_camera().forward_world(), forward) > std::cos(glm::radians(46.0f)));
  studio.camera().set_pose(worst);  // an offer is for the view in which it was made
  REQUIRE(hands.app.settle());
  CHECK(frame() == first);
}

TEST_CASE("hands: F before there are thumbnails leaves the room that they will cover") {
  Hands hands(false);
  Studio& studio = hands.studio();
  studio.apply(SelectVolume{{true, hands.under(hands.app.screen_of(kOnApple)), glm::vec3(0.25f)}});
  REQUIRE(hands.selected() > 0);
  REQUIRE(hands.app->interface().covered_bottom(studio) == 0);
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const UiRect view = hands.app->interface().viewport();
  const float lowest = view.max.y - hands.app->interface().kept_bottom(studio);
  const auto labels = studio.labels(studio.document().active);
  std::size_t below = 0;
  for (std::size_t g = 0; g < labels.size(); ++g)
    below += labels[g] && hands.seen_at(studio.scene()->cloud->position[g]).y > lowest;
  CHECK(static_cast<double>(below) < 0.03 * static_cast<double>(count_flags(labels)));
}

TEST_CASE("hands: what an object is set into does not stand before it") {
  const ScratchFolder folder("rivet");
  Scene scene;  // half of a ball in a sheet whose blurred splats lie over it, seen from the front
  GaussianCloud& cloud = scene.cloud;
  constexpr std::size_t kBall = 400, kSheet = 3000;
  cloud = random_cloud(kBall + kSheet, 5, 0, 0.04f);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const bool ball = g < kBall;
    const glm::vec3 p = cloud.position[g];
    cloud.position[g] = ball ? 0.1f * glm::normalize(p) : glm::vec3(p.x, p.y, 0.05f * p.z - 0.06f);
    cloud.opacity[g] = ball ? 0.9f : 0.5f;
  }
  scene.file_rows = cloud.size();
  save_scene(folder / "rivet.ply", scene, {}, SceneFormat::kPly);
  Hands hands(false, with_kept_scenes(), folder / "rivet.ply");
  Studio& studio = hands.studio();
  studio.apply(SelectVolume{{true, {0, 0, 0}, glm::vec3(0.11f)}});
  REQUIRE(hands.app.settle());
  REQUIRE(hands.selected() > kBall / 4);
  studio.apply(GoToCamera{look_at({0, 0, -1}, {0, 0, 0}, {0, -1, 0}, 0.9f, 640, 480)});
  REQUIRE(hands.app.settle());
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("stands before") == std::string::npos);
}

TEST_CASE("hands: while a flight key is held the wheel changes the speed, else it goes nearer") {
  Hands hands(false);
  hands.app.move(hands.app.screen_of(kOnMug));
  const auto flown = [&] {
    const glm::vec3 before = hands.studio().camera().pose().position_world;
    hands.app.frames(10);
    return glm::distance(before, hands.studio().camera().pose().position_world);
  };
  hands.app->handle(KeyChanged{'W', true, false, {}});
  const float usual = flown();
  CHECK(usual > 0);
  hands.app->handle(WheelTurned{-4, {}});
  CHECK(hands.studio().view().fly_speed < 0.5f);
  CHECK(flown() < 0.6f * usual);
  hands.app->handle(KeyChanged{'W', false, false, {}});
  const float speed = hands.studio().view().fly_speed;
  hands.app->handle(WheelTurned{-1, {}});
  CHECK(hands.studio().view().fly_speed == speed);
}

TEST_CASE("hands: the axes in the corner turn the view, and take the click") {
  Hands hands(false);
  hands.app.key(key::kKeypad7);
  REQUIRE(hands.app.settle());
  const glm::vec3 forward = hands.studio().viewport().pane_camera().forward_world();
  CHECK(glm::dot(forward, hands.studio().document().up_world) < -0.99f);
  const UiRect view = hands.app->interface().viewport();
  const glm::vec2 middle(view.max.x - 55, view.min.y + 55);
  CHECK_FALSE(hands.app->interface().picture_at(middle, hands.studio()));
  hands.app.key(key::kKeypad1);
  REQUIRE(hands.app.settle());
  const glm::vec3 right(glm::row(hands.studio().viewport().pane_camera().camera_from_world_rotation, 0));
  const float x_side = right.x > 0 ? 1.0f : -1.0f;
  REQUIRE(std::abs(right.x) > 0.99f);
  hands.app.click(middle + glm::vec2(x_side * 34, 0));  // the ball of +X
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport().pane_camera().forward_world().x < -0.99f);
}

namespace {

// Where the active object is seen, in logical points of the picture.
UiRect seen_object(Hands& hands) {
  const Camera camera = hands.studio().viewport().pane_camera();
  const std::vector<std::uint8_t> labels = hands.studio().labels(hands.studio().document().active);
  const Image<float> weight = render_labels(hands.studio().scene()->scene->cloud, camera, labels);
  UiRect box{glm::vec2(1e9f), glm::vec2(-1e9f)};
  for (int y = 0; y < weight.height(); ++y)
    for (int x = 0; x < weight.width(); ++x)
      if (weight.at(x, y) > 0.5f) {
        box.min = glm::min(box.min, glm::vec2(x, y));
        box.max = glm::max(box.max, glm::vec2(x + 1, y + 1));
      }
  return box;
}

}  // namespace

TEST_CASE("hands: F lets the object fill four fifths of what is free of the picture") {
  Hands hands = hands_on_sample();
  hands.app.key('I');  // nothing stands before it
  for (const glm::vec2 turn : {glm::vec2(0), glm::vec2(160, 30), glm::vec2(-90, 60)}) {
    hands.studio().camera().orbit(turn);
    hands.app.key('F');
    REQUIRE(hands.app.settle());
    const UiRect seen = seen_object(hands);
    const Camera camera = hands.studio().viewport().pane_camera();
    const float free =
        static_cast<float>(camera.height_px) - hands.app->interface().covered_bottom(hands.studio());
    const glm::vec2 share = seen.size() / glm::vec2(static_cast<float>(camera.width_px), free);
    CAPTURE(share.x);
    CAPTURE(share.y);
    CHECK(std::max(share.x, share.y) > 0.74f);
    CHECK(std::max(share.x, share.y) < 0.88f);
    const glm::vec2 middle = 0.5f * (seen.min + seen.max);
    CHECK(std::abs(middle.x / static_cast<float>(camera.width_px) - 0.5f) < 0.03f);
    CHECK(std::abs(middle.y / free - 0.5f) < 0.03f);
  }
}

TEST_CASE("hands: alone, the object is what the view turns around, corrected or not") {
  Hands hands = hands_on_sample();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const glm::vec3 rim = hands.under(hands.app.screen_of(kOnApple + glm::vec2(40, 20)));
  hands.app.click(hands.seen_at(rim));  // a correction far from the middle
  REQUIRE(hands.app.settle());
  const auto middle = [&] {
    const UiRect seen = seen_object(hands);
    return 0.5f * (seen.min + seen.max);
  };
  const glm::vec2 before = middle();
  hands.studio().camera().orbit({400, 0});
  REQUIRE(hands.app.settle());
  CHECK(glm::distance(before, middle()) < 12);
}

TEST_CASE("a view that has no picture yet says what is coming, and no more once it is there") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  CHECK(app.studio().coming().empty());
  app.open(kSmallSample);
  CHECK(app.studio().coming() == "Opening small_sample.compressed.ply");
  app.frames(1);
  CHECK(app.button("Open a file").size().x == 0);  // nothing else is to be chosen now
  while (!app.studio().scene()) app.frames(1);
  REQUIRE(!app.studio().viewport().picture());
  CHECK(app.studio().coming() == "Drawing the first picture...");
  REQUIRE(app.settle());
  CHECK(app.studio().coming().empty());
}

TEST_CASE("hands: F frames the object as if strays far behind it were not there") {
  Hands hands = hands_on_sample();
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const float distance = hands.studio().camera().pose().distance;
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const Camera camera = hands.studio().viewport().pane_camera();
  // The farthest from it, a twentieth as many.
  std::vector<std::size_t> order(cloud.size());
  for (std::size_t g = 0; g < order.size(); ++g) order[g] = g;
  const glm::vec3 middle = camera.centre_world() + distance * camera.forward_world();
  std::ranges::sort(order, std::ranges::greater(),
                    [&](std::size_t g) { return glm::distance(cloud.position[g], middle); });
  std::vector<std::uint8_t> with_strays = labels;
  for (std::size_t i = 0; i < count_flags(labels) / 20; ++i) with_strays[order[7 * i]] = 1;
  const auto rotation = hands.studio().camera().pose().camera_from_world;
  const auto framed = [&](const std::vector<glm::vec3>& of) {
    return hands.studio().camera().framing(of, camera, 0, rotation).pose.distance;
  };
  std::vector<glm::vec3> all;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (with_strays[g]) all.push_back(cloud.position[g]);
  const float alone = framed(hands.studio().viewport().object_points());
  CHECK(framed(all) > 1.3f * alone);  // what it was
  CHECK(framed(shown_points(cloud, with_strays)) == doctest::Approx(alone).epsilon(0.05));
}

TEST_CASE("hands: looked at from the front, right or above, the object stays above the thumbnails") {
  Hands hands = hands_on_sample();
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const float lowest =
      hands.app->interface().viewport().max.y - hands.app->interface().covered_bottom(hands.studio());
  for (const int code : {int(key::kKeypad1), int(key::kKeypad3), int(key::kKeypad7)}) {
    CAPTURE(code);
    hands.studio().camera().zoom(5);  // too near
    hands.app.frames(2);
    hands.app.key(code);
    REQUIRE(hands.app.settle());
    const auto labels = hands.studio().labels(hands.studio().document().active);
    std::size_t inside = 0, all = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) {
      if (!labels[g]) continue;
      const glm::vec2 at = hands.seen_at(hands.studio().scene()->cloud->position[g]);
      ++all;
      inside += hands.app->interface().viewport().contains(at) && at.y < lowest;
    }
    CHECK(static_cast<double>(inside) > 0.97 * static_cast<double>(all));
  }
}

TEST_CASE(
    "hands: a drag turns the view about nothing that lies behind what the middle of the picture shows") {
  Hands hands(false);
  CameraController& camera = hands.studio().camera();
  CameraPose pose = camera.pose();
  const auto middle =
      hands.under(hands.app->interface().viewport().min + 0.5f * hands.app->interface().viewport().size());
  const float away = glm::distance(middle, pose.position_world);
  pose.distance = 40 * away;
  camera.set_pose(pose);
  REQUIRE(hands.app.settle());
  const glm::vec2 from = hands.app->interface().viewport().min + glm::vec2(60, 200);
  hands.app.drag({from, from + glm::vec2(90, 0), from + glm::vec2(120, 0)});
  CHECK(camera.pose().distance < 1.5f * away);
  CHECK(glm::distance(camera.pose().position_world, pose.position_world) < 1.5f * away);
  CHECK(glm::distance(camera.pose().position_world, pose.position_world) > 0.1f * away);
}
