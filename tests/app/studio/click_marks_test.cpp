// Dots of clicks: where they show, and that a click on one takes its click away.
#include <doctest/doctest.h>

#include <algorithm>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::vec2 kElsewhere{300, 60};

std::vector<std::uint8_t> labels_of_active(Hands& hands) {
  REQUIRE(hands.app.settle());
  return hands.studio().labels(hands.studio().document().active);
}

std::size_t strokes(Hands& hands) {
  return stroke_count(*hands.studio().document().active_object());
}

void go_away(Hands& hands) {
  hands.app.move(hands.app->interface().viewport().min + kElsewhere);
  hands.app.frames(2);
}

void click_again(Hands& hands, const glm::vec2& at, PointerButton button = PointerButton::kRight) {
  go_away(hands);
  hands.app.click(at, button);
  REQUIRE(hands.app.settle());
}

void turn(Hands& hands, float points) {
  const glm::vec2 from = hands.app->interface().viewport().min + glm::vec2(80, 250);
  hands.app.drag({from, from + glm::vec2(0.5f * points, 0), from + glm::vec2(points, 0)},
                 PointerButton::kMiddle);
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
}

}  // namespace

TEST_CASE("marks: what hands took out stays out, and what they added stays, when a click is taken away") {
  Hands hands;
  Studio& studio = hands.studio();
  const glm::vec2 on_orange = hands.app.screen_of(kOnOrange);
  hands.app.click(on_orange);
  const auto both = labels_of_active(hands);
  const auto region = [&](const glm::vec2& pixel, SetOperation operation) {
    const glm::vec2 at = hands.in_viewport(hands.app.screen_of(pixel)), half(9, 9);
    const Camera camera = studio.viewport().pane_camera();
    studio.apply(SelectRegion{
        camera, rectangle_region(at - half, at + half, camera.width_px, camera.height_px), operation});
    return labels_of_active(hands);
  };
  const auto without = region(kOnApple, SetOperation::kRemove);
  const auto by_hand = region(kOnMug, SetOperation::kAdd);
  REQUIRE(count_flags(without) < count_flags(both));
  REQUIRE(count_flags(by_hand) > count_flags(without));
  const auto holds = [&] {
    const auto now = labels_of_active(hands);
    for (std::size_t g = 0; g < now.size(); ++g) {
      REQUIRE_FALSE((both[g] && !without[g] && now[g]));
      REQUIRE_FALSE((by_hand[g] && !without[g] && !now[g]));
    }
  };
  click_again(hands, on_orange);
  REQUIRE(strokes(hands) == 1);
  holds();
  hands.app.key('Z', {.ctrl = true});
  studio.apply(RemoveStroke{0, 0, studio.document().active_object()->views[0].strokes[0].points_px[0]});
  REQUIRE(labels_of_active(hands) != by_hand);
  REQUIRE(strokes(hands) == 1);
  holds();
  studio.apply(RemoveStroke{0, 0, studio.document().active_object()->views[0].strokes[0].points_px[0]});
  REQUIRE(studio.document().active_object()->views.empty());
  holds();
}

TEST_CASE("marks: what hands took of another object stays when the click that shared it is taken away") {
  Hands hands;
  Studio& studio = hands.studio();
  const glm::vec2 on_apple = hands.app.screen_of(kOnApple);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  hands.app.click(on_apple);  // shared from here
  const auto before = labels_of_active(hands);
  const glm::vec2 at = hands.in_viewport(hands.app.screen_of(kOnOrange)), half(9, 9);
  const Camera camera = studio.viewport().pane_camera();
  studio.apply(
      SelectRegion{camera, rectangle_region(at - half, at + half, camera.width_px, camera.height_px)});
  const auto by_hand = labels_of_active(hands);
  REQUIRE(count_flags(by_hand) > count_flags(before));
  click_again(hands, on_apple);
  REQUIRE(strokes(hands) == 1);
  const auto now = labels_of_active(hands);
  CHECK(now != by_hand);
  for (std::size_t g = 0; g < now.size(); ++g) REQUIRE_FALSE((by_hand[g] && !before[g] && !now[g]));
}

TEST_CASE("marks: a click on the dot of a click takes that away, whichever it is") {
  Hands hands;
  const auto apple = labels_of_active(hands);
  const glm::vec2 on_apple = hands.app.screen_of(kOnApple), on_orange = hands.app.screen_of(kOnOrange);
  hands.app.click(on_orange);
  const auto both = labels_of_active(hands);
  REQUIRE(both != apple);
  SUBCASE("the last one; undo brings it back") {
    click_again(hands, on_orange);
    CHECK(strokes(hands) == 1);
    CHECK(labels_of_active(hands) == apple);
    hands.app.key('Z', {.ctrl = true});
    CHECK(strokes(hands) == 2);
    CHECK(labels_of_active(hands) == both);
  }
  SUBCASE("a right click, by a left one; a second of its own kind is one more") {
    const glm::vec2 beside = on_orange + glm::vec2(0, 14);
    click_again(hands, beside, PointerButton::kRight);
    REQUIRE(strokes(hands) == 3);
    click_again(hands, beside, PointerButton::kRight);
    CHECK(strokes(hands) == 4);
    click_again(hands, beside, PointerButton::kLeft);
    click_again(hands, beside, PointerButton::kLeft);
    CHECK(strokes(hands) == 2);
    CHECK(labels_of_active(hands) == both);
  }
  SUBCASE("the first one: what is left means what it means by itself") {
    click_again(hands, on_apple);
    CHECK(strokes(hands) == 1);
    const auto left = labels_of_active(hands);
    Hands alone(false);
    alone.app.click(on_orange);
    CHECK(left == labels_of_active(alone));
  }
  SUBCASE("all of them: the object is empty") {
    click_again(hands, on_apple);
    click_again(hands, on_orange);
    CHECK(hands.studio().document().active_object()->views.empty());
    CHECK(hands.selected() == 0);
  }
  SUBCASE("those on the object: what is left of right ones goes with them") {
    click_again(hands, on_orange);
    click_again(hands, on_orange);  // a right click now
    REQUIRE(strokes(hands) == 2);
    click_again(hands, on_apple);
    CHECK(hands.studio().document().active_object()->views.empty());
    CHECK(hands.selected() == 0);
    CHECK(hands.said().find("those on the rest with it") != std::string::npos);
  }
  SUBCASE("one that changed nothing: nobody is told to click nearer") {
    const glm::vec2 beside = on_apple + glm::vec2(0, 16);
    hands.app.click(beside);
    REQUIRE(labels_of_active(hands) == both);
    click_again(hands, beside);
    CHECK(strokes(hands) == 2);
    CHECK(labels_of_active(hands) == both);
    CHECK(hands.said().find("nearer") == std::string::npos);
  }
  SUBCASE("not that of a locked object") {
    hands.studio().apply(LockObject{hands.studio().document().active, true});
    click_again(hands, on_apple);
    CHECK(strokes(hands) == 2);
    CHECK(hands.said().find("locked") != std::string::npos);
  }
}

TEST_CASE("marks: what a click took from another object is left to that again once it is taken away") {
  Hands hands;
  const glm::vec2 on_apple = hands.app.screen_of(kOnApple), on_orange = hands.app.screen_of(kOnOrange);
  hands.app.key('N', {.ctrl = true});
  hands.app.click(on_orange);
  const auto orange = labels_of_active(hands);
  const auto left = [&] { return hands.studio().document().active_object()->of_others; };
  REQUIRE(left());
  hands.app.click(on_apple);
  REQUIRE(hands.app.settle());
  REQUIRE(!left());
  click_again(hands, on_apple);
  REQUIRE(left());
  CHECK(labels_of_active(hands) == orange);
  const auto& document = hands.studio().document();
  CHECK(*left() == hands.studio().labels(document.objects.front().id));
}

TEST_CASE("marks: a click where the pointer still stands is one more") {
  Hands hands;
  hands.app.click(hands.app.screen_of(kOnApple), PointerButton::kRight);
  REQUIRE(hands.app.settle());
  CHECK(strokes(hands) == 2);
}

TEST_CASE("marks: dots stand on the surface in every view, unless something hides them") {
  Hands hands;
  const glm::vec2 on_apple = hands.app.screen_of(kOnApple);
  const glm::vec3 there = hands.under(on_apple);
  hands.app.click(hands.app.screen_of(kOnOrange));  // which the view turns about
  REQUIRE(hands.app.settle());
  turn(hands, 60);
  const glm::vec2 seen = hands.in_viewport(hands.seen_at(there));
  CHECK(glm::distance(seen, hands.in_viewport(on_apple)) > 20);
  const std::vector<StrokeMark>& marks = hands.studio().viewport().marks();
  REQUIRE(marks.size() == 2);
  CHECK(!marks.front().from_here);
  CHECK(glm::distance(marks.front().at_px, seen) < 1.5f);
  SUBCASE("what is clicked there goes") {
    click_again(hands, hands.seen_at(there));
    CHECK(strokes(hands) == 1);
  }
  SUBCASE("behind the fruit there is none") {
    turn(hands, 420);
    CHECK(hands.studio().viewport().marks().empty());
  }
}

TEST_CASE("marks: a cross says what a press does, and no outline beside it") {
  Hands hands;
  hands.app.wait_for_message_to_go();
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  const auto ink = [&] { return hands.app.picture().at(static_cast<int>(at.x + 9), static_cast<int>(at.y)); };
  CHECK(!hands.studio().clicks().pointed_mark());  // the pointer has not left
  go_away(hands);
  const Rgb8 before = ink();
  hands.app.move(at + glm::vec2(1, 1));
  hands.app.frames(2);
  REQUIRE(hands.studio().clicks().pointed_mark());
  const Rgb8 ring = ink();
  CHECK(std::min({ring[0], ring[1], ring[2]}) > 200);
  CHECK(ring != before);
  hands.app.key('5');  // another tool
  CHECK(!hands.studio().clicks().pointed_mark());
}

TEST_CASE("marks: what is said at a dot beside the panel stays inside of the picture") {
  Hands hands;
  const UiRect view = hands.app->interface().viewport();
  const glm::vec2 at(view.max.x - 20, view.min.y + 0.7f * view.size().y);
  hands.app.click(at);
  REQUIRE(hands.app.settle());
  hands.app.move(view.min + 60.0f);
  hands.app.frames(2);
  hands.app.move(at);
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().clicks().pointed_mark());
  hands.app.frames(3);
  const UiRect told = hands.app.window("##Tooltip");
  REQUIRE(told.size().x > 50);
  CHECK(told.max.x <= view.max.x);
  CHECK(told.max.y <= view.max.y);
}
