// What the window says and shows of sides that a stroke changed out of its sight, through undo, edits by hand
// and saved work.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/document/selection.h"
#include "app/picture/cut_sentences.h"
#include "app/ui/panels.h"
#include "reopened.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr const char* kTookFarSide = "what is red here was taken away, unseen from where you clicked or drew";

const std::vector<ViewCard>& cards(HeadlessApp& app) {
  return app.studio().cuts().run(app.studio().document().active)->views;
}

std::ptrdiff_t of_stroke(HeadlessApp& app) {
  return std::ranges::count_if(cards(app), &ViewCard::doubt_of_stroke);
}

// In no order: that depends on what was shown before.
std::vector<std::vector<Rgba8>> pixels(HeadlessApp& app) {
  std::vector<std::vector<Rgba8>> all;
  for (const ViewCard& card : cards(app))
    all.emplace_back(card.picture->pixels().begin(), card.picture->pixels().end());
  std::ranges::sort(all);
  return all;
}

void click_on(Hands& hands, const glm::vec2& thing, PointerButton button) {
  hands.app.click(hands.app.screen_of(thing), button);
  REQUIRE(hands.app.settle());
}

}  // namespace

TEST_CASE("sides: a right click that takes far sides is told of, and the pictures say where") {
  Hands hands = hands_on_sample();
  for (const glm::vec2& thing : {kOnOrange, kOnMug}) {
    CAPTURE(thing.x);
    click_on(hands, thing, PointerButton::kLeft);
    CHECK(std::ranges::count(cards(hands.app), kTookFarSide, &ViewCard::doubt) == 0);
    click_on(hands, thing, PointerButton::kRight);
    CHECK(of_stroke(hands.app) >= 2);
    CHECK(cards(hands.app).front().doubt != kTookFarSide);
    CHECK(tip_of_card(cards(hands.app).front(), 0, true).find("\nRed left") != std::string::npos);
    CHECK(std::ranges::count(cards(hands.app), kTookFarSide, &ViewCard::doubt) == of_stroke(hands.app));
    CHECK(hands.said().find("sides in doubt are marked in the thumbnails") != std::string::npos);
    const CutRun& run = *hands.studio().cuts().run(hands.studio().document().active);
    CHECK(has_cut_notes(hands.studio(), true));
    CHECK(has_cut_notes(hands.studio(), false) == (run.doubts.size() > 1));  // where there are none to see
  }
  // The turntable says so, too: in the colour of warnings, in which nothing else of it is.
  const auto warnings = [&] {
    hands.app.frames(3);
    const UiRect at = hands.app.window("###turntable");
    const Image<Rgb8> picture = hands.app.picture();
    int pixels = 0;
    for (int y = static_cast<int>(at.min.y); y < static_cast<int>(at.max.y); ++y)
      for (int x = static_cast<int>(at.min.x); x < static_cast<int>(at.max.x); ++x) {
        const Rgb8 p = picture.at(x, y);
        pixels += p[0] > 2 * p[2] && p[1] > p[2] && p[0] > 128;
      }
    return pixels;
  };
  hands.app.interface_state().turntable_open = true;
  CHECK(warnings() > 100);
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  // The next answer ends the doubt, before its own pictures are there.
  Studio& studio = hands.studio();
  const std::uint64_t done = studio.cuts().done();
  studio.apply(AddStroke{studio.viewport().pane_camera(),
                         click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
  while (studio.cuts().done() == done) studio.update(1.0 / 60);
  CHECK(std::ranges::count(cards(hands.app), kTookFarSide, &ViewCard::doubt) == 0);
}

TEST_CASE("sides: pictures show the change that led to what undo, redo and saved work show") {
  Hands hands = hands_on_sample();
  const auto apple = pixels(hands.app);
  click_on(hands, kOnOrange, PointerButton::kLeft);
  const auto both = pixels(hands.app);
  click_on(hands, kOnOrange, PointerButton::kRight);
  const auto less = pixels(hands.app);
  const auto marks = of_stroke(hands.app);
  REQUIRE(marks > 0);
  const auto after = [&](const Command& command) {
    hands.studio().apply(command);
    REQUIRE(hands.app.settle());
    return pixels(hands.app);
  };
  CHECK(after(Undo{}) == both);
  CHECK(after(Undo{}) == apple);
  CHECK(after(Redo{}) == both);
  CHECK(after(Redo{}) == less);
  CHECK(of_stroke(hands.app) == marks);
  // A name changes nothing; a rectangle over the mug is no stroke, and its undo shows the stroke again.
  CHECK(after(RenameObject{hands.studio().document().active, "apple"}) == less);
  const Camera camera = hands.studio().viewport().pane_camera();
  const glm::vec2 at = hands.in_viewport(hands.app.screen_of(kOnMug));
  CHECK(after(SelectRegion{
            camera, rectangle_region(at - 10.0f, at + 10.0f, camera.width_px, camera.height_px)}) != less);
  CHECK(of_stroke(hands.app) == 0);
  CHECK(after(Undo{}) == less);

  const ScratchFolder folder("sides");
  const auto again = reopened(hands, folder);
  CHECK(cards(*again).size() == less.size());
  CHECK(of_stroke(*again) == marks);
}

TEST_CASE("sides: in whatever steps the wheel came to a size, the pictures show the same change") {
  Hands hands = hands_on_sample();
  const auto own = pixels(hands.app);
  const auto after = [&](int key) {
    hands.app.key(key);
    REQUIRE(hands.app.settle());
    return pixels(hands.app);
  };
  const auto smaller = after(key::kPageDown);
  for (const bool again : {false, true}) {  // in the same words
    CAPTURE(again);
    CHECK(std::ranges::count(cards(hands.app), kTookFarSide, &ViewCard::doubt) > 0);
    CHECK(hands.said().find("sides in doubt are marked in the thumbnails") != std::string::npos);
    if (again) break;
    hands.studio().apply(Undo{});
    REQUIRE(hands.app.settle());
    CHECK(after(key::kPageDown) == smaller);
  }
  const auto smallest = after(key::kPageDown);
  CHECK(smallest != smaller);
  CHECK(after(key::kPageUp) == smaller);
  CHECK(after(key::kPageUp) == own);
  CHECK(of_stroke(hands.app) == 0);
}

TEST_CASE(
    "sides: what nobody looked at stays in doubt after the next stroke, until it is looked at or back") {
  constexpr const char* kBefore =
      "something here was taken away before, unseen from where you clicked or drew";
  Hands hands = hands_on_sample();
  const auto still = [&] { return std::ranges::count(cards(hands.app), kBefore, &ViewCard::doubt); };
  hands.app.key(key::kPageDown);  // a part of the apple's front: the back goes
  REQUIRE(hands.app.settle());
  REQUIRE(of_stroke(hands.app) >= 3);
  click_on(hands, kOnMug, PointerButton::kLeft);
  const auto open = still();
  CHECK(open >= 1);
  click_on(hands, kOnOrange, PointerButton::kLeft);
  CHECK(still() >= 1);
  SUBCASE("a hand changes something else") {
    const Camera camera = hands.studio().viewport().pane_camera();
    const glm::vec2 at = hands.in_viewport(hands.app.screen_of({200, 500}));
    hands.studio().apply(
        SelectRegion{camera, rectangle_region(at - 10.0f, at + 10.0f, camera.width_px, camera.height_px)});
    REQUIRE(hands.app.settle());
    CHECK(still() >= 1);
  }
  SUBCASE("undo and redo") {
    for (const Command& command : {Command(Undo{}), Command(Redo{})}) {
      hands.studio().apply(command);
      REQUIRE(hands.app.settle());
      CHECK(still() >= 1);
    }
  }
  SUBCASE("somebody looks at each side") {
    const Camera front = hands.studio().viewport().pane_camera();
    const std::vector<ViewCard> sides = cards(hands.app);
    for (const ViewCard& side : sides) {
      hands.studio().apply(GoToCamera{side.camera});
      REQUIRE(hands.app.settle());
    }
    CHECK(still() >= 1);  // it has its mark while it is looked at
    hands.studio().apply(GoToCamera{front});
    REQUIRE(hands.app.settle());
    hands.studio().apply(StepScale{-1});  // of the last click, whose sides they are
    REQUIRE(hands.app.settle());
    CHECK(still() == 0);
    click_on(hands, kOnMug, PointerButton::kRight);
    CHECK(still() == 0);
  }
  SUBCASE("all of the apple is back") {
    const GaussianCloud& cloud = *hands.studio().scene()->cloud;
    const auto apple = sample_truth(*hands.studio().scene()->scene, kApple);
    glm::vec3 low(1e9f), high(-1e9f);
    for (std::size_t g = 0; g < apple.size(); ++g)
      if (apple[g]) low = glm::min(low, cloud.position[g]), high = glm::max(high, cloud.position[g]);
    const Volume volume{false, 0.5f * (low + high), 0.5f * (high - low)};
    hands.studio().apply(SelectVolume{volume});
    REQUIRE(hands.app.settle());
    CHECK(still() == 0);
  }
}

TEST_CASE("sides: what is in doubt stays so where a click is taken away, and wherever undo and redo lead") {
  Hands hands = hands_on_sample();
  const glm::vec2 on_orange = hands.app.screen_of(kOnOrange), beside = on_orange + glm::vec2(0, 14);
  const auto doubts = [&] {
    std::vector<std::string> all;
    for (const ViewCard& card : cards(hands.app))
      if (!card.doubt.empty()) all.push_back(card.doubt);
    std::ranges::sort(all);
    return all;
  };
  const auto of_before = [&] {
    return std::ranges::count_if(cards(hands.app),
                                 [](const ViewCard& c) { return c.doubt.starts_with("something here"); });
  };
  const auto after = [&](const Command& command) {
    hands.studio().apply(command);
    REQUIRE(hands.app.settle());
    return doubts();
  };
  const auto press = [&](const glm::vec2& at, PointerButton button) {
    hands.app.move(hands.app->interface().viewport().min + glm::vec2(300, 60));
    hands.app.frames(2);
    hands.app.click(at, button);
    REQUIRE(hands.app.settle());
  };
  const auto strokes = [&] { return stroke_count(*hands.studio().document().active_object()); };
  press(on_orange, PointerButton::kLeft);
  const auto both = doubts();
  REQUIRE(of_stroke(hands.app) > 0);
  SUBCASE("the last click, whose state was there before") {
    press(beside, PointerButton::kRight);
    const auto corrected = doubts();
    const auto pictures = pixels(hands.app);
    press(beside, PointerButton::kLeft);
    REQUIRE(strokes() == 2);
    const auto taken_back = doubts();
    CHECK(of_before() > 0);
    for (int i = 0; i < 2; ++i) {
      CHECK(after(Undo{}) == corrected);
      CHECK(pixels(hands.app) == pictures);
      CHECK(after(Redo{}) == taken_back);
    }
    hands.studio().apply(Undo{});
    CHECK(after(Undo{}) == both);
    CHECK(after(Redo{}) == corrected);
  }
  SUBCASE("the first click") {
    press(hands.app.screen_of(kOnApple), PointerButton::kRight);
    REQUIRE(strokes() == 1);
    CHECK(of_before() > 0);
  }
  SUBCASE("what was looked at stays looked at") {
    const Camera front = hands.studio().viewport().pane_camera();
    const std::vector<ViewCard> sides = cards(hands.app);
    for (const ViewCard& side : sides) after(GoToCamera{side.camera});
    after(GoToCamera{front});
    press(beside, PointerButton::kRight);
    CHECK(of_before() == 0);
    press(beside, PointerButton::kLeft);
    CHECK(of_before() == 0);
    hands.studio().apply(Undo{});
    CHECK(after(Undo{}) == both);
    press(hands.app.screen_of(kOnMug), PointerButton::kLeft);
    CHECK(of_before() == 0);
  }
}
