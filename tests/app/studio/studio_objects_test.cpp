// Objects as hands expect them: a colour of their own, nothing of what others have, and locked ones stay.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: another method does not change what is locked") {
  Hands hands = hands_on_sample();
  Studio& studio = hands.studio();
  const ObjectId object = studio.document().active;
  const auto before = studio.labels(object);
  studio.apply(LockObject{object, true});
  studio.apply(SetPreset{"paper-code"});
  REQUIRE(hands.app.settle());
  CHECK(studio.labels(object) == before);
  studio.apply(LockObject{object, false});
  REQUIRE(hands.app.settle());
  CHECK(studio.labels(object) != before);
}

TEST_CASE("hands: an object's colour is one that shows on what was clicked, and stays") {
  Hands hands = hands_on_sample(false);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const Rgb8 on_orange = hands.studio().document().active_object()->colour;
  CHECK(on_orange[2] > on_orange[0]);  // bluish; an object's first colour is orange
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().document().active_object()->colour == on_orange);
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().document().active_object()->colour != on_orange);
}

TEST_CASE("hands: an object that is begun again after an undo keeps its colour where that shows") {
  Hands hands = hands_on_sample(false);
  const auto begun_on = [&](const glm::vec2& thing) {
    hands.app.click(hands.app.screen_of(thing));
    REQUIRE(hands.app.settle());
    const Rgb8 colour = hands.studio().document().active_object()->colour;
    hands.app.key('Z', {.ctrl = true});
    REQUIRE(hands.app.settle());
    REQUIRE(hands.studio().document().objects.empty());
    return colour;
  };
  const Rgb8 on_mug = begun_on(kOnMug), on_orange = begun_on(kOnOrange);
  REQUIRE(on_orange != on_mug);  // that would not show there
  CHECK(begun_on(kOnMug) == on_orange);
}

TEST_CASE("hands: a new object leaves to the others what they have, unless it is clicked on that") {
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = studio.labels(studio.document().active);
  const glm::vec2 middle = hands.in_viewport(hands.app.screen_of(kOnApple));
  ViewState view = studio.view();
  view.see_through = true;
  studio.apply(SetView{view});
  const Camera camera = studio.viewport().pane_camera();
  studio.apply(SelectRegion{
      camera, rectangle_region({0, 0}, {middle.x, camera.height_px}, camera.width_px, camera.height_px),
      SetOperation::kIntersect});
  REQUIRE(hands.app.settle());
  const auto left_half = studio.labels(1);
  REQUIRE(count_flags(left_half) > 0);
  const auto shared = [&](ObjectId object) {
    const auto labels = studio.labels(object);
    std::size_t both = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) both += labels[g] && left_half[g];
    return both;
  };
  const auto click_new = [&](float aside) {
    studio.apply(NewObject{});
    hands.app.click(hands.app.screen_of(kOnApple) + glm::vec2(aside, 0));
    REQUIRE(hands.app.settle());
    return studio.document().active;
  };
  const ObjectId right = click_new(14);
  CHECK(shared(right) == 0);
  CHECK(hands.selected() > 0);
  CHECK(std::ranges::any_of(studio.messages(), [](const Message& m) {
    return m.text.find("that Object 1 had before stay its own") != std::string::npos;
  }));
  const ScratchFolder folder("of_others");
  studio.apply(SaveWork{folder / "two.splatcut.json"});
  REQUIRE(hands.app.settle());
  Hands other(false);
  other.app.open(folder / "two.splatcut.json");
  REQUIRE(other.app.settle());
  CHECK(other.studio().labels(right) == studio.labels(right));

  studio.apply(LeaveToOthers{right, false});
  REQUIRE(hands.app.settle());
  CHECK(iou_of(studio.labels(right), apple) > 0.95);
  studio.apply(LeaveToOthers{right, true});
  REQUIRE(hands.app.settle());
  CHECK(shared(right) == 0);
  CHECK(studio.labels(1) == left_half);

  studio.apply(RemoveObject{right});
  float on_left = 0;  // where the first object shows
  for (float aside = -2; aside > -40 && on_left == 0; --aside)
    if (const auto hit = studio.viewport().pick(middle + glm::vec2(aside, 0));
        hit && left_half[static_cast<std::size_t>(hit->gaussian)])
      on_left = aside;
  REQUIRE(on_left != 0);
  const ObjectId on_it = click_new(on_left);
  CHECK(shared(on_it) > count_flags(left_half) / 2);
}

TEST_CASE("hands: all that is selected by hand is not without the others, and is at the first choice") {
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = studio.labels(studio.document().active);
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const ObjectId second = studio.document().active;
  CHECK(is_without_others(studio.document(), *studio.document().find(second), apple.size()));
  hands.app.key('A', {.ctrl = true});
  REQUIRE(hands.selected() == apple.size());
  CHECK_FALSE(
      is_without_others(studio.document(), *studio.document().find(second), apple.size()));  // no tick
  studio.apply(LeaveToOthers{second, true});
  CHECK(hands.selected() == apple.size() - count_flags(apple));
  CHECK(hands.said().find("Now without the other objects: Object 2: ") == 0);
  CHECK(is_without_others(studio.document(), *studio.document().find(second), apple.size()));
  studio.apply(LeaveToOthers{second, false});
  CHECK(hands.selected() == apple.size());
  CHECK(hands.said().find("Now with what others have: Object 2: ") == 0);
}

TEST_CASE("hands: no two objects have one colour while others are free") {
  Hands hands(false);
  Studio& studio = hands.studio();
  const auto colours = [&] {
    std::set<Rgb8> all;
    for (const ObjectItem& object : studio.document().objects) all.insert(object.colour);
    return all.size();
  };
  studio.apply(NewObject{});
  studio.apply(NewObject{});
  const ObjectItem second = studio.document().objects.back();
  studio.apply(Undo{});
  studio.apply(RecolourObject{studio.document().objects.front().id, second.colour});
  for (std::size_t objects = 2; objects <= 8; ++objects) {
    studio.apply(NewObject{});
    CHECK(studio.document().objects.size() == objects);
    CHECK(colours() == objects);
  }
  studio.apply(NewObject{});  // there are eight
  CHECK(colours() == 8);
}
