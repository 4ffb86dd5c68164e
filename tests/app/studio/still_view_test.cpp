// The view stays under a shape while it is drawn, and a drag ends with its scene.
#include <doctest/doctest.h>

#include <functional>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("still view: wheel and flight keys wait until a shape is drawn") {
  Hands hands(false);
  const glm::vec2 from = hands.app.screen_of(kOnApple), to = hands.app.screen_of(kOnOrange);
  const auto pose = [&] { return hands.studio().camera().pose(); };
  const auto try_to_move = [&] {
    hands.app->handle(WheelTurned{3, {}});
    hands.app->handle(KeyChanged{'W', true, false, {}});
    hands.app.frames(10);
    hands.app->handle(KeyChanged{'W', false, false, {}});
    REQUIRE(hands.app.settle());
  };
  const auto stays = [&] {
    const CameraPose before = pose();
    try_to_move();
    return pose().position_world == before.position_world && pose().distance == before.distance;
  };
  for (const int tool : {'5', '6', '7', '3'}) {
    CAPTURE(tool);
    hands.app.key(tool);
    hands.app.move(from);
    hands.app.press(PointerButton::kLeft);
    hands.app.move(to);
    hands.app.frames(1);
    CHECK(stays());
    const float brush = hands.studio().view().brush_px;
    hands.app->handle(WheelTurned{1, {.alt = true}});
    CHECK(hands.studio().view().brush_px > brush);
    hands.app.key(key::kEscape);
    hands.app.release(PointerButton::kLeft);
    REQUIRE(hands.app.settle());
  }
  hands.app.key('8');
  hands.app.click(from);
  hands.app.click(to);
  REQUIRE(hands.studio().tools().at_work());
  CHECK(stays());
  hands.app.key(key::kEscape);
  CHECK_FALSE(stays());
}

TEST_CASE("still view: a press ends with its scene, and the next one counts") {
  for (const bool waits : {false, true}) {
    CAPTURE(waits);
    Hands hands;
    const glm::vec2 at = hands.app.screen_of(kOnApple);
    hands.app.move(at);
    if (waits) hands.studio().run(Action::kIsolate);  // the events wait until the apple is alone
    hands.app.press(PointerButton::kLeft);
    hands.app.frames(1);
    hands.studio().apply(OpenScene{kSmallSample});
    if (waits) hands.app.release(PointerButton::kLeft);
    REQUIRE(hands.app.settle());
    CHECK_FALSE(hands.studio().tools().dragging());
    if (!waits) hands.app.release(PointerButton::kLeft);
    REQUIRE(hands.app.settle());
    CHECK(hands.studio().document().objects.empty());  // no click in the scene that came
    hands.app->advance(0.5);
    hands.app.click(hands.app.screen_of(kOnApple));
    CHECK(hands.selected() > 0);
  }
}

TEST_CASE("still view: a drag of the camera goes on in the scene that comes") {
  Hands hands(false);
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  hands.app.move(at);
  hands.app.press(PointerButton::kMiddle);
  hands.app.move(at + glm::vec2(30, 0));
  hands.studio().apply(OpenScene{kSmallSample});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().tools().dragging());
  hands.app.release(PointerButton::kMiddle);
  CHECK_FALSE(hands.studio().tools().dragging());
}

TEST_CASE("still view: keys, axes and drags that put the view elsewhere are refused until a shape is drawn") {
  Hands hands;
  const glm::vec2 from = hands.app.screen_of(kOnApple), to = hands.app.screen_of(kOnOrange);
  const auto stays = [&](const std::function<void()>& act) {
    const CameraPose before = hands.studio().camera().goal();
    act();
    REQUIRE(hands.app.settle());
    return hands.studio().camera().goal() == before;
  };
  const auto all_stay = [&] {
    for (const int code : {int{'F'}, key::kHome, int{'N'}, int{'P'}}) {
      CAPTURE(code);
      CHECK(stays([&] { hands.app.key(code); }));
      CHECK(hands.said().find("the view stays while a shape is drawn") != std::string::npos);
    }
    CHECK(stays([&] { hands.studio().apply(LookAlong{{0, 0, 1}}); }));
  };
  hands.app.key('7');
  hands.app.move(from);
  hands.app.press(PointerButton::kLeft);
  hands.app.move(to);
  all_stay();
  hands.app.key(key::kEscape);
  hands.app.release(PointerButton::kLeft);
  hands.app.key('8');
  hands.app.click(from);
  hands.app.click(to);
  REQUIRE(hands.studio().tools().at_work());
  all_stay();
  CHECK(stays([&] { hands.app.drag({to, to + glm::vec2(60, 0)}, PointerButton::kMiddle); }));
  hands.app.key(key::kEscape);
  for (const int code : {int{'F'}, key::kHome, int{'N'}}) CHECK_FALSE(stays([&] { hands.app.key(code); }));
}

TEST_CASE("still view: over the axes in the picture's corner a click is a corner of what is drawn") {
  HeadlessApp app(1500, 900, 1, with_kept_scenes());  // wide: no options over the picture
  app.interface_state().hint_wanted = false;
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.wait_for_message_to_go();
  const UiRect picture = app->interface().viewport();
  app.key('8');
  app.click(app.screen_of(kOnApple));
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.studio().tools().at_work());
  for (float y = 10; y < 130; y += 12)
    for (float x = 10; x < 100; x += 12) {
      CAPTURE(x);
      CAPTURE(y);
      app->advance(1);  // no double click
      app.move({picture.max.x - x, picture.min.y + y});
      const std::size_t before = app.studio().overlay().points_px.size();
      app.click({picture.max.x - x, picture.min.y + y});
      CHECK(app.studio().overlay().points_px.size() == before + 1);
    }
}
