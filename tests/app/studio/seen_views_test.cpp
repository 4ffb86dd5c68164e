// What no view saw of an object, and of the ground below it, in the window.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE(
    "hands: without the object the ground that it hid from all views is outlined, until labels change") {
  Hands hands = hands_on_sample(false);
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().seen_views().ground() == nullptr);  // nobody asked
  hands.app.key('H');
  REQUIRE(hands.app.settle());
  const OpenedScene& scene = *hands.studio().scene();
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const UnseenGround expected =
      unseen_ground(*scene.cloud, labels, hands.studio().document().up_world, scene.views().cameras, {});
  REQUIRE(expected.why_not.empty());
  CHECK(expected.area > 0);
  const UnseenGround* ground = hands.studio().seen_views().ground();
  REQUIRE(ground);
  CHECK(ground->area == expected.area);
  CHECK(ground->outline_world == expected.outline_world);
  const auto ink = [&] {
    hands.app.frames(2);
    const Image<Rgb8> picture = hands.app.picture();
    return std::ranges::count(picture.pixels(), Rgb8{255, 120, 90});
  };
  CHECK(ink() > 20);
  hands.studio().apply(EditSelection{SelectionEdit::kGrow});
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().seen_views().ground());
  CHECK(hands.studio().seen_views().ground() != ground);
  hands.app.key('H', {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(ink() < 5);
}

TEST_CASE("ground that nobody saw: below the fruits of the sample it is a disc around where they touch") {
  const Scene scene = load_scene(kSample);
  const std::vector<Camera> cameras = load_cameras(kSampleFolder / "cameras.json");
  for (const std::uint8_t fruit : {kApple, kOrange}) {
    CAPTURE(static_cast<int>(fruit));
    const std::vector<std::uint8_t> labels = sample_truth(scene, fruit);
    const UnseenGround ground = unseen_ground(scene.cloud, labels, {0, -1, 0}, cameras, {});
    REQUIRE(ground.why_not.empty());
    const auto radius = static_cast<double>(object_extent(scene.cloud, labels).radius);
    CHECK(ground.area > 0.02 * M_PI * radius * radius);
    CHECK(ground.area < 0.3 * M_PI * radius * radius);
  }
}

TEST_CASE("hands: the object alone is red where no view saw it and blue where many did") {
  Hands hands = hands_on_sample();
  hands.app.key('M', {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().view().display == DisplayMode::kIsolate);
  const auto heat = hands.studio().viewport().style(0).heat;
  REQUIRE(heat);
  const OpenedScene& scene = *hands.studio().scene();
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const SeenFrom seen =
      seen_by_views(*scene.cloud, labels, hands.studio().document().up_world, scene.views().cameras, {});
  std::size_t own = 0, never = 0;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (!labels[g]) continue;
    const bool unseen = seen.by_views[own++] == 0;
    never += unseen;
    CHECK(((*heat)[g] == 1) == unseen);
  }
  CHECK(never < own);
  CHECK(std::ranges::count(*heat, 0.0f) > static_cast<std::ptrdiff_t>(labels.size() - own));
  hands.app.key('M', {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport().style(0).heat == nullptr);
}

TEST_CASE("hands: Esc stops looking who saw the object, and the key asked again looks again") {
  Hands hands = hands_on_sample();
  const auto looking = [&] { return hands.studio().seen_views().looking(); };
  const auto stop = [&] {
    REQUIRE(hands.app.frames_until(looking));
    hands.app.key(key::kEscape);
    REQUIRE(hands.app.settle());
    CHECK_FALSE(looking());
  };
  hands.app.key('M', {.shift = true});
  stop();
  CHECK(shows_seen_heat(hands.studio().view()));
  CHECK(hands.studio().viewport().style(0).heat == nullptr);
  for (int i = 0; i < 2; ++i) hands.app.key('M', {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport().style(0).heat != nullptr);
  hands.app.key('H');
  stop();
  CHECK(hands.studio().view().display == DisplayMode::kHide);
  CHECK(hands.studio().seen_views().ground() == nullptr);
  for (int i = 0; i < 2; ++i) hands.app.key('H');
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().seen_views().ground() != nullptr);
  // Nobody waits for it any more.
  hands.studio().apply(EditSelection{SelectionEdit::kGrow});
  REQUIRE(hands.app.frames_until(looking));
  hands.app.key('H');
  REQUIRE(hands.app.settle());
  CHECK_FALSE(looking());
  CHECK(hands.studio().seen_views().ground() == nullptr);  // it was not seen to its end
}

TEST_CASE(
    "hands: who saw the object is shown until it is not alone any more, and goes back to where it was") {
  Hands hands = hands_on_sample();
  const auto shown = [&] {
    REQUIRE(hands.app.settle());
    return std::pair(hands.studio().view().display, hands.studio().view().seen_heat.has_value());
  };
  hands.app.key('M', {.shift = true});
  CHECK(shown() == std::pair(DisplayMode::kIsolate, true));
  hands.app.key('M', {.shift = true});
  CHECK(shown() == std::pair(DisplayMode::kWhole, false));
  hands.app.key('I');
  hands.app.key('M', {.shift = true});
  CHECK(shown() == std::pair(DisplayMode::kIsolate, true));
  hands.app.key('M', {.shift = true});
  CHECK(shown() == std::pair(DisplayMode::kIsolate, false));
  hands.app.key('M', {.shift = true});
  REQUIRE(shown() == std::pair(DisplayMode::kIsolate, true));
  hands.app.key(key::kEscape);
  CHECK(shown() == std::pair(DisplayMode::kWhole, false));
  hands.app.key('I');
  CHECK(shown() == std::pair(DisplayMode::kIsolate, false));
}
