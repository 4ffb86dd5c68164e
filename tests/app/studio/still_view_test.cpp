// The view stays under a shape while it is drawn, and a drag ends with its scene.
#include <doctest/doctest.h>

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
