// How the scene is shown: backgrounds, the object alone, side by side, floaters, not beyond the far limit.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "app/document/document_edits.h"
#include "app/document/words.h"
#include "hands.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: backgrounds go round, and the checker is behind the object alone") {
  Hands hands;
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const auto corner = [&](int x, int y) {
    return hands.studio().viewport().picture()->pictures.front().at(x, y);
  };
  std::vector<Rgba8> seen;
  for (std::size_t i = 0; i < backdrops().size(); ++i) {
    hands.app.key('J');
    REQUIRE(hands.app.settle());
    CHECK(hands.said() == std::string("Background: ") + backdrops()[(i + 1) % backdrops().size()].name);
    seen.push_back(corner(3, 3));
    if (hands.studio().view().checker)
      CHECK(corner(3, 3) != corner(3 + 12, 3));
    else
      CHECK(corner(3, 3) == corner(3 + 12, 3));
  }
  CHECK(seen[1] == Rgba8{255, 255, 255, 255});
  CHECK(seen[3] == Rgba8{255, 0, 255, 255});
  CHECK(shows(backdrops()[0], hands.studio().document(), hands.studio().view()));
}

TEST_CASE("hands: the view turns at once while another display comes, and what is clicked waits for it") {
  Hands hands;
  Studio& studio = hands.studio();
  const glm::vec2 from(200, 150);
  const auto turned = [&](DisplayMode display, PointerButton button) {
    ViewState view = studio.view();
    view.display = display;
    studio.apply(SetView{view});
    REQUIRE_FALSE(studio.viewport().display_current());
    const CameraPose before = studio.camera().pose();
    studio.pointer_moved(from, {});
    studio.pointer_pressed(from, button, {});
    for (int i = 1; i < 4; ++i) studio.pointer_moved(from + 10.0f * glm::vec2(i, 0), {});
    const bool at_once = studio.camera().pose() != before;
    studio.pointer_released(from + glm::vec2(30, 0), button, {});
    REQUIRE(hands.app.settle());
    CHECK(studio.camera().pose() != before);
    CHECK_FALSE(studio.tools().dragging());
    return at_once;
  };
  CHECK(turned(DisplayMode::kIsolate, PointerButton::kMiddle));
  CHECK_FALSE(turned(DisplayMode::kWhole, PointerButton::kLeft));  // it could be a click
  CHECK_FALSE(turned(DisplayMode::kSideBySide, PointerButton::kMiddle));
  CHECK_FALSE(turned(DisplayMode::kIsolate, PointerButton::kMiddle));  // from two panes
}

TEST_CASE("hands: a drag goes on in the pane where it was pressed") {
  Hands hands;
  hands.app.key('B');
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().viewport().panes() == 2);
  const UiRect view = hands.app->interface().viewport();
  const glm::vec2 left = view.min + glm::vec2(120, 150), half(0.5f * view.size().x, 0);
  const CameraPose before = hands.studio().camera().pose();
  const auto turned = [&](const glm::vec2& from) {
    hands.studio().camera().set_pose(before);
    hands.app.drag({from, from + glm::vec2(10, 4), from + glm::vec2(20, 8)}, PointerButton::kMiddle);
    return hands.studio().camera().pose().camera_from_world;  // each pane may turn about what it shows
  };
  CHECK(turned(left) == turned(left + half));
  hands.app.key('6');
  hands.app.move(left + half);
  hands.app.press(PointerButton::kLeft);
  hands.app.move(left + half + glm::vec2(12, 0));
  for (const glm::vec2& p : hands.studio().overlay().points_px)
    CHECK(glm::distance(p, glm::vec2(120, 150)) < 15);
  hands.app.release(PointerButton::kLeft);
}

TEST_CASE("hands: side by side, what is drawn in the right pane takes what that pane shows") {
  Hands hands;
  Studio& studio = hands.studio();
  const std::size_t apple = hands.selected();
  ViewState view = studio.view();
  view.display = DisplayMode::kSideBySide;
  view.tool = Tool::kRectangle;
  studio.apply(SetView{view});
  REQUIRE(hands.app.settle());
  const UiRect area = hands.app->interface().viewport();
  const glm::vec2 size = area.size();
  const auto drag = [&](float from, float to) {
    hands.app.drag({area.min + size * glm::vec2(from, 0.1f), area.min + size * glm::vec2(to, 0.8f)});
    return hands.selected();
  };
  CHECK(drag(0.55f, 0.95f) == apple);  // the object stands there alone
  CHECK(drag(0.05f, 0.45f) > 2 * apple);
}

namespace {

// Pixels of each pane's middle, free of labels, that differ between two frames.
std::array<int, 2> changed_in_panes(const UiRect& area, const Image<Rgb8>& a, const Image<Rgb8>& b) {
  std::array<int, 2> changed{};
  const glm::vec2 middle = 0.5f * (area.min + area.max);
  for (int y = static_cast<int>(area.min.y) + 110; y < static_cast<int>(area.max.y) - 60; ++y)
    for (int x = static_cast<int>(area.min.x) + 5; x < static_cast<int>(area.max.x) - 5; ++x)
      if (std::abs(static_cast<float>(x) - middle.x) > 4)
        changed[static_cast<float>(x) > middle.x] += a.at(x, y) != b.at(x, y);
  return changed;
}

}  // namespace

TEST_CASE("hands: side by side, a shape lies in the pane where it is drawn, and a volume in both") {
  Hands hands;
  HeadlessApp& app = hands.app;
  app.key('B');
  REQUIRE(app.settle());
  const UiRect area = app->interface().viewport();
  const glm::vec2 right(area.min.x + 0.75f * area.size().x, area.min.y + 0.5f * area.size().y);
  const auto frame_of = [&](int tool) {
    app.key(tool);
    app.move(right);
    REQUIRE(app.settle());
    app.wait_for_message_to_go();
    return app.picture();
  };
  const Image<Rgb8> before_polygon = frame_of('8');
  for (const glm::vec2& corner : {glm::vec2(-40, -30), {40, -30}, {0, 40}}) app.click(right + corner);
  app.move(right);
  app.frames(2);
  const auto [polygon_left, polygon_right] = changed_in_panes(area, before_polygon, app.picture());
  CHECK(polygon_left == 0);
  CHECK(polygon_right > 100);
  hands.studio().run(Action::kCancel);
  const Image<Rgb8> before_volume = frame_of('9');
  const glm::vec2 on_apple = app.screen_of(kOnApple) + glm::vec2(0.5f * area.size().x, 0);
  app.move(on_apple);
  app.press(PointerButton::kLeft);
  app.move(on_apple + glm::vec2(40, 0));
  app.frames(2);
  const auto [volume_left, volume_right] = changed_in_panes(area, before_volume, app.picture());
  CHECK(volume_left > 300);
  CHECK(volume_right > 300);
  app.release(PointerButton::kLeft);
}

TEST_CASE("hands: side by side, the wheel comes nearer to what the pane under the pointer shows") {
  Hands hands;
  hands.app.key('B');
  REQUIRE(hands.app.settle());
  const UiRect area = hands.app->interface().viewport();
  const glm::vec2 at(60, 130);  // the wall in the left pane, and nothing in the right one
  const Camera camera = hands.studio().viewport().pane_camera();
  REQUIRE(hands.studio().viewport().pick(at));
  CameraController expected = hands.studio().camera();
  expected.zoom(2, camera.world_from_pixel(at, expected.pose().distance));
  hands.app.move(area.min + at + glm::vec2(0.5f * area.size().x, 0));
  hands.studio().wheel(2, {});
  CHECK(glm::distance(hands.studio().camera().pose().position_world, expected.pose().position_world) < 1e-4f);
}

TEST_CASE("hands: alone, an object that stays empty is no black picture") {
  Hands hands;
  Studio& studio = hands.studio();
  studio.run(Action::kIsolate);
  REQUIRE(hands.app.settle());
  REQUIRE(studio.view().display == DisplayMode::kIsolate);
  studio.apply(Recompute{});
  hands.app.frames(1);
  studio.apply(NewObject{});
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK(studio.view().display == DisplayMode::kWhole);
}

TEST_CASE("hands: with everything undone the whole scene is shown, not an empty object alone") {
  Hands hands;
  hands.app.key('I');
  REQUIRE(hands.studio().view().display == DisplayMode::kIsolate);
  hands.studio().apply(JumpHistory{0});
  hands.app.frames(2);
  CHECK(hands.studio().view().display == DisplayMode::kWhole);
}

TEST_CASE("hands: floaters are shown as long as there are any") {
  HeadlessApp app;
  REQUIRE(cut_out_apple(app));
  Studio& studio = app.studio();
  studio.apply(EditSelection{SelectionEdit::kRemoveFloaters});
  REQUIRE(app.settle());
  studio.apply(ShowFloaters{true});
  REQUIRE(app.settle());
  CHECK_FALSE(studio.viewport().floaters_shown());
  CHECK(studio.messages().back().text == "Nothing floats apart from the object");
  // A few Gaussians of the lamp's shade, far from the apple.
  const std::vector<std::uint8_t> lamp = sample_truth(*studio.scene()->scene, 5);
  const std::size_t of_lamp = static_cast<std::size_t>(std::ranges::find(lamp, 1) - lamp.begin());
  REQUIRE(of_lamp < lamp.size());
  const glm::vec3 there = studio.scene()->cloud->position[of_lamp];
  studio.apply(SelectVolume{{true, there, glm::vec3(0.01f)}, SetOperation::kAdd, false});
  REQUIRE(app.settle());
  studio.apply(ShowFloaters{true});
  REQUIRE(app.settle());
  CHECK(studio.viewport().floaters_shown());
  const std::size_t floaters = studio.viewport().floater_count();
  CHECK(floaters > 0);
  studio.apply(EditSelection{SelectionEdit::kRemoveFloaters});
  REQUIRE(app.settle());
  CHECK_FALSE(studio.viewport().floaters_shown());
  CHECK(
      studio.messages().back().text.starts_with(gaussians_text(floaters) + " that floated apart removed. "));
}

TEST_CASE("far limit: what is within it is looked for once a view") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  ViewState view = app.studio().view();
  view.far_share = 0.5f;
  app.studio().apply(SetView{view});
  REQUIRE(app.settle());
  const Flags within = app.studio().viewport().seen(0);
  REQUIRE(within);
  CHECK(app.studio().viewport().seen(0) == within);
  view.far_share = 0.4f;
  app.studio().apply(SetView{view});
  CHECK(app.studio().viewport().seen(0) != within);
}

TEST_CASE("far limit: what lies beyond is neither drawn nor picked nor selected") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  const glm::vec2 wall(60, 60), apple = app.screen_of(kOnApple) - app->interface().viewport().min;
  REQUIRE(app.studio().viewport().pick(wall));
  REQUIRE(app.studio().viewport().pick(apple));
  const Camera camera = app.studio().viewport().pane_camera();
  const auto depth = [&](const glm::vec2& at) {
    return camera.camera_from_world(app.studio().viewport().pick(at)->position_world).z;
  };
  const float near_z = depth(apple), far_z = depth(wall), limit = 0.5f * (near_z + far_z);
  REQUIRE(near_z < far_z);
  ViewState view = app.studio().view();
  view.far_share = limit / app.studio().camera().scene_size();
  app.studio().apply(SetView{view});
  CHECK_FALSE(app.studio().viewport().pick(wall));  // one pixel drawn for the question
  REQUIRE(app.settle());
  CHECK_FALSE(app.studio().viewport().pick(wall));  // the picture on the screen
  CHECK(app.studio().viewport().pick(apple));
  const Frame& frame = *app.studio().viewport().picture()->frames.front();
  const GaussianCloud& cloud = *app.studio().scene()->cloud;
  float farthest = 0;
  for (const std::int32_t g : frame.first_hit.pixels())
    if (g >= 0)
      farthest = std::max(farthest, camera.camera_from_world(cloud.position[static_cast<std::size_t>(g)]).z);
  CHECK(farthest <= limit);
  CHECK(farthest > near_z);
  view.far_share = 0;
  app.studio().apply(SetView{view});
  REQUIRE(app.settle());
  CHECK(app.studio().viewport().pick(wall));
}
