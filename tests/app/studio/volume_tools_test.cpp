// Spheres and boxes in space that select: drawn, changed by their handles, replaced.
#include <doctest/doctest.h>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: a sphere and a box in space select by a drag, and again by their handles") {
  Hands hands = hands_on_sample(false);
  const Scene& scene = *hands.studio().scene()->scene;
  const auto apple = sample_truth(scene, kApple);
  const auto share = [&] {
    REQUIRE(hands.app.settle());
    const auto labels = hands.studio().labels(hands.studio().document().active);
    std::size_t both = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) both += labels[g] && apple[g];
    return static_cast<double>(both) / static_cast<double>(count_flags(apple));
  };
  for (const char tool : {'9', 'Y'}) {
    CAPTURE(tool);
    hands.app.key(tool);
    const std::size_t steps = hands.steps();
    const glm::vec2 at = hands.app.screen_of(kOnApple);
    hands.app.drag({at, at + glm::vec2(20, 0), at + glm::vec2(30, 0)});
    const std::size_t first = hands.selected();
    const double part = share();
    CHECK(first > 100);
    CHECK(hands.steps() == steps + 1);
    const auto handles = hands.studio().overlay().handles_px;
    REQUIRE(handles.size() == (tool == '9' ? 2 : 7));
    const glm::vec2 low = hands.app->interface().viewport().min;
    const glm::vec2 middle = low + handles[0], rim = low + handles[1];
    const glm::vec2 outwards = glm::normalize(rim - middle) * 30.0f;
    hands.app.drag({rim, rim + 0.5f * outwards, rim + outwards});
    CHECK(hands.selected() > first);
    CHECK(share() >= part);
    CHECK(hands.steps() == steps + 1);  // one step, as it was changed
    const std::size_t larger = hands.selected();
    const glm::vec2 now = low + hands.studio().overlay().handles_px[0];  // a box keeps its other face
    hands.app.drag({now, now + glm::vec2(200, -150), now + glm::vec2(400, -300)});
    CHECK(hands.selected() != larger);
    CHECK(hands.steps() == steps + 1);
    hands.app.key(key::kEscape);
    CHECK(hands.studio().overlay().handles_px.empty());
    hands.app.key('Z', {.ctrl = true});
    CHECK(hands.selected() == 0);
  }
}

TEST_CASE("hands: a volume that took nothing yet is changed without a step before it being lost") {
  Hands hands(false);
  hands.studio().apply(NewObject{});
  const std::size_t steps = hands.steps();
  const Volume nowhere{true, glm::vec3(1e4f), glm::vec3(1)};
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd});
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd, true});
  CHECK(hands.steps() == steps);
  CHECK(hands.studio().document().objects.size() == 1);
  // Nor one after it.
  hands.studio().apply(NewObject{});
  hands.studio().apply(Undo{});
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd});
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd, true});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().history().can_redo());
}

TEST_CASE("hands: a volume replaces what it took, though a cut is done in between") {
  Hands hands;
  const Volume on_mug{true, hands.under(hands.app.screen_of(kOnMug)), glm::vec3(0.1f)};
  const Volume nowhere{true, glm::vec3(1e4f), glm::vec3(1)};
  hands.studio().apply(
      AddStroke{hands.studio().viewport().pane_camera(),
                click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
  hands.studio().update(1.0 / 60);
  REQUIRE(hands.studio().cutting());
  hands.studio().apply(SelectVolume{on_mug, SetOperation::kAdd});
  REQUIRE(hands.app.settle());
  const std::size_t steps = hands.steps();
  const ObjectItem& object = *hands.studio().document().active_object();
  REQUIRE(object.cut);
  REQUIRE(hands.selected() > count_flags(*object.cut));
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd, true});
  CHECK(hands.steps() == steps);
  const ObjectItem& now = *hands.studio().document().active_object();
  CHECK(hands.studio().labels(now.id) == *now.cut);
}

TEST_CASE(
    "hands: a volume changed while its object is shown alone takes what was to be seen, and ends nothing") {
  Hands hands = hands_on_sample(false);
  const Volume small{true, hands.under(hands.app.screen_of(kOnApple)), glm::vec3(0.02f)};
  Volume large = small;
  large.half = glm::vec3(0.1f);
  hands.studio().apply(SelectVolume{small, SetOperation::kAdd});
  REQUIRE(hands.app.settle());
  const std::size_t first = hands.selected();
  REQUIRE(first > 0);
  hands.studio().run(Action::kIsolate);
  REQUIRE(hands.app.settle());
  hands.studio().apply(SelectVolume{large, SetOperation::kAdd, true});
  CHECK(hands.selected() > first);
  CHECK(hands.studio().view().display == DisplayMode::kIsolate);
}

TEST_CASE("hands: a press without a drag leaves the sphere that is there") {
  Hands hands(false);
  hands.app.key('9');
  const glm::vec2 at = hands.app.screen_of(kOnApple), beside = hands.app.screen_of(kOnOrange);
  hands.app.drag({at, at + glm::vec2(20, 0), at + glm::vec2(30, 0)});
  const auto handles = hands.studio().overlay().handles_px;
  REQUIRE(handles.size() == 2);
  const std::size_t steps = hands.steps();
  hands.app.click(beside);
  CHECK(hands.studio().overlay().handles_px == handles);
  CHECK(hands.steps() == steps);
}
