// The camera as hands expect it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <nlohmann/json.hpp>

#include "hands.h"
#include "scene/cloud/strays.h"
#include "segment/session/doubts.h"

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
  hands.app.press_item("side/notes", {"Come nearer"});
  REQUIRE(hands.app.settle());
  const float near = glm::distance(hands.studio().camera().pose().position_world, apple);
  CHECK(near < 0.4f * far);
  CHECK(glm::distance(hands.seen_at(apple), hands.app->interface().viewport().min +
                                                0.5f * hands.app->interface().viewport().size()) < 30);
  hands.app.press_item("side/notes", {"Come nearer"});  // still there: nothing was clicked from here
  REQUIRE(hands.app.settle());
  hands.app.click(hands.seen_at(apple));
  REQUIRE(hands.app.settle());
  const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
  CHECK(std::ranges::none_of(run->doubts, [](const auto& d) { return d.ends_with("come nearer"); }));
  CHECK(hands.said().find("first view") == std::string::npos);
}

TEST_CASE("hands: it is said to step back from what the picture crops until all of it was seen") {
  Hands hands(false, with_kept_scenes(), kSample);
  const glm::vec3 mug = hands.under(hands.app.screen_of(kOnMug));
  hands.studio().camera().approach(mug, 0.25f);
  REQUIRE(hands.app.settle());
  const auto doubted = [&] {
    const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
    return run && std::ranges::find(run->doubts, kRunsOut) != run->doubts.end();
  };
  hands.app.click(hands.seen_at(mug));
  REQUIRE(hands.app.settle());
  for (int step = 0; step < 8 && !doubted(); ++step) {
    hands.app.key(key::kPageUp);
    REQUIRE(hands.app.settle());
  }
  REQUIRE(doubted());
  hands.app.frames(5);
  CHECK(doubted());
  hands.app.key('F');  // all of it
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  CHECK_FALSE(doubted());
  hands.studio().apply(Undo{});
  hands.studio().apply(Redo{});
  REQUIRE(hands.app.settle());
  CHECK_FALSE(doubted());
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

TEST_CASE("hands: the view turns around what a box took") {
  Hands hands(false);
  hands.app.key('4');
  const glm::vec2 apple = hands.app.screen_of(kOnApple);
  hands.app.drag({apple - glm::vec2(45, 45), apple, apple + glm::vec2(45, 45)});
  REQUIRE(hands.selected() > 0);
  const glm::vec3 middle = robust_bounds(hands.studio().viewport().object_points()).centre();
  CHECK(glm::distance(hands.studio().camera().turned_around(), middle) < 1e-4f);
  const glm::vec2 before = hands.seen_at(middle);
  hands.app.drag({{300, 120}, {360, 120}, {420, 120}}, PointerButton::kMiddle);
  CHECK(glm::distance(hands.seen_at(middle), before) < 3);
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
