// The pointer leaves the window.
#include <doctest/doctest.h>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

bool pointer_somewhere(Hands& hands) {
  hands.app->interface().make_current();
  hands.app.frames(2);
  return ImGui::IsMousePosValid();
}

}  // namespace

TEST_CASE("pointer left: nothing of it stays in the window") {
  Hands hands(false);
  hands.app.key('5');
  hands.app.wait_for_message_to_go();
  const Image<Rgb8> without = hands.app.picture();
  const glm::vec2 middle = hands.app.screen_of(kOnApple);
  hands.app.move(middle);
  hands.app.frames(2);
  CHECK_FALSE(hands.app.picture() == without);  // the ring of the brush
  hands.app->handle(PointerLeft());
  CHECK_FALSE(pointer_somewhere(hands));
  CHECK(hands.app.picture() == without);
}

TEST_CASE("pointer left: a drag goes on outside, and ends there") {
  Hands hands(false);
  hands.app.key('5');
  hands.app.move(hands.app.screen_of(kOnApple));
  hands.app.press(PointerButton::kLeft);
  hands.app.move(hands.app.screen_of(kOnOrange));
  hands.app->handle(PointerLeft());
  CHECK(pointer_somewhere(hands));
  hands.app.move({-20, 100});  // GLFW says where it is outside, while a button is held
  hands.app.release(PointerButton::kLeft);
  CHECK_FALSE(pointer_somewhere(hands));
  CHECK(hands.selected() > 0);
}

TEST_CASE("pointer left: it comes back where it moves") {
  Hands hands(false);
  hands.app->handle(PointerLeft());
  hands.app.move(hands.app.screen_of(kOnApple));
  CHECK(pointer_somewhere(hands));
  hands.app.press(PointerButton::kLeft);
  hands.app.release(PointerButton::kLeft);
  CHECK(hands.selected() > 0);
}
