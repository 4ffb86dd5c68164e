// What artists' hands know from other tools: keys, double-clicks, clicks that are answered, the history,
// words.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/document/words.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: numbers are written one way, lengths with three figures") {
  CHECK(grouped(999) == "999");
  CHECK(grouped(92440) == "92,440");
  CHECK(grouped(1234567) == "1,234,567");
  CHECK(as_sentence("one side is in doubt") == "One side is in doubt");
  CHECK(length_text(0) == "0");
  CHECK(length_text(0.0235f) == "0.0235");
  CHECK(length_text(12.4f) == "12.4");
  CHECK(length_text(1250.4f) == "1,250");
  CHECK(scene_name("a/garden.ply") == "garden.ply");
  CHECK(scene_name("a/garden/meta.json") == "garden");
  CHECK(scene_name("a/garden/lod-meta.json") == "garden");
  CHECK(scene_name("a/garden/") == "garden");
  CHECK(scene_name("meta.json") == std::filesystem::current_path().filename());
  Hands hands(false);
  CHECK(std::ranges::any_of(hands.studio().messages(), [](const Message& m) {
    return m.text.find("3,000") != std::string::npos && m.text.find("Gaussians") != std::string::npos;
  }));
  hands.app.key('A', {.ctrl = true});
  CHECK(hands.said().find("3,000") != std::string::npos);
}

TEST_CASE("hands: a held bracket key changes the brush no more than threefold in a second") {
  Hands hands(false);
  hands.app.key('5');
  const float before = hands.studio().view().brush_px;
  hands.app->handle(KeyChanged{']', true, false, {}});
  for (int i = 0; i < 60; ++i) {
    hands.app.frames(1);
    hands.app->handle(KeyChanged{']', true, true, {}});
  }
  hands.app->handle(KeyChanged{']', false, false, {}});
  CHECK(hands.studio().view().brush_px > 1.5f * before);
  CHECK(hands.studio().view().brush_px < 3 * before);
}

TEST_CASE("hands: thumbnails follow the history") {
  Hands hands;
  const auto serials = [&] {
    std::vector<std::uint64_t> out;
    const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
    if (run)
      for (const ViewCard& card : run->views) out.push_back(card.serial);
    return out;
  };
  const auto first = serials();
  REQUIRE(first.size() > 1);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto second = serials();
  REQUIRE(second.size() > 1);
  CHECK(second != first);
  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(serials() == first);
  hands.app.key('Z', {.shift = true, .ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(serials() == second);
  hands.studio().apply(JumpHistory{0});
  REQUIRE(hands.app.settle());
  CHECK(serials().empty());
}

TEST_CASE("hands: thumbnails that a second click kept from being drawn are drawn after its undo") {
  Hands patient = hands_on_sample(), hasty = hands_on_sample(false);
  const auto views = [](Hands& hands) {
    return hands.studio().cuts().run(hands.studio().document().active)->views;
  };
  const auto same = [](const ViewCard& a, const ViewCard& b) {
    return a.used == b.used && a.only_to_look == b.only_to_look && a.doubt == b.doubt &&
           std::ranges::equal(a.picture->pixels(), b.picture->pixels());
  };
  Studio& studio = hasty.studio();
  const auto click_on = [&](const glm::vec2& thing) {
    studio.apply(AddStroke{studio.viewport().pane_camera(),
                           click(hasty.in_viewport(hasty.app.screen_of(thing)), SeedLabel::kObject)});
  };
  for (const bool once_more : {false, true}) {  // then the result is known, and its pictures are those before
    CAPTURE(once_more);
    const std::uint64_t done = studio.cuts().done();
    if (once_more)
      studio.apply(Recompute{});
    else
      click_on(kOnApple);
    while (studio.cuts().done() == done) studio.update(1.0 / 60);
    click_on(kOnOrange);
    studio.update(1.0 / 60);
    REQUIRE(studio.cutting());
    studio.apply(Undo{});
    REQUIRE(hasty.app.settle());
    CHECK(std::ranges::equal(views(hasty), views(patient), same));
  }
}

TEST_CASE("hands: undone or cancelled while it is cut, the cut before is on show again") {
  for (const bool cancelled : {false, true}) {
    CAPTURE(cancelled);
    Hands hands;
    const ObjectId apple = hands.studio().document().active;
    const auto result = hands.studio().cuts().run(apple)->result;
    REQUIRE(result);
    hands.studio().apply(
        AddStroke{hands.studio().viewport().pane_camera(),
                  click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
    hands.studio().update(1.0 / 60);
    REQUIRE(hands.studio().cutting());
    hands.studio().apply(cancelled ? Command(Cancel{}) : Undo{});
    REQUIRE(hands.app.settle());
    REQUIRE(hands.studio().cuts().run(apple));
    CHECK(hands.studio().cuts().run(apple)->result == result);
    CHECK_FALSE(hands.studio().cuts().run(apple)->views.empty());
  }
}

TEST_CASE("hands: Alt+click where the preset has no parts says why it does nothing") {
  Hands hands;
  hands.studio().apply(SetPreset{"paper"});
  const std::size_t before = hands.studio().messages().size();
  hands.studio().apply(
      IntersectStroke{hands.studio().viewport().pane_camera(),
                      click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
  REQUIRE(hands.app.settle());
  CHECK(std::any_of(hands.studio().messages().begin() + static_cast<std::ptrdiff_t>(before),
                    hands.studio().messages().end(),
                    [](const Message& m) { return m.kind == Message::Kind::kRefused; }));
  hands.studio().apply(IntersectStroke{hands.studio().viewport().pane_camera(), {}});
  CHECK(hands.studio().messages().back().kind == Message::Kind::kRefused);
}

TEST_CASE("hands: Esc closes a menu before it changes the tool") {
  Hands hands(false);
  hands.app.key('5');
  hands.app.click({kHandsWidth - 316 + 289, 0});  // nothing there
  hands.app.interface_state().recent = {kSmallSample};
  hands.app.frames(2);
  hands.app.press_item("bar", {icon::kDown});
  REQUIRE(hands.app->interface().dialog_open());
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  CHECK(hands.studio().view().tool == Tool::kBrush);
  hands.app.key(key::kEscape);
  CHECK(hands.studio().view().tool == Tool::kClick);
}

TEST_CASE("hands: two presses are a double-click by their own times, however slow the frames") {
  Hands hands(false);
  hands.app.key('1');
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  const auto distance = [&] { return hands.studio().camera().pose().distance; };
  const auto two = [&](double apart_s) {
    hands.app.move(at);
    for (const double t : {100.0, 100.0 + apart_s}) {
      hands.app->handle(PointerButtonChanged{PointerButton::kLeft, true, {}, t});
      hands.app->frame(0.6);  // slower than any hand
      hands.app->handle(PointerButtonChanged{PointerButton::kLeft, false, {}, t + 0.05});
      hands.app->frame(0.6);
    }
    REQUIRE(hands.app.settle());
  };
  const float before = distance();
  two(0.8);
  CHECK(distance() == before);
  two(0.2);
  CHECK(distance() != before);
}

TEST_CASE("hands: a stroke that begins where the last one ended, soon after it, counts") {
  Hands hands(false);
  hands.app.key('5');
  REQUIRE(hands.studio().view().tool == Tool::kBrush);
  const glm::vec2 apple = hands.app.screen_of(kOnApple), orange = hands.app.screen_of(kOnOrange);
  const auto stroke = [&](const glm::vec2& from, const glm::vec2& to, double at_s) {
    hands.app.move(from);
    hands.app->handle(PointerButtonChanged{PointerButton::kLeft, true, {}, at_s});
    for (const float share : {0.25f, 0.5f, 0.75f, 1.0f}) {
      hands.app.move(glm::mix(from, to, share));
      hands.app.frames(1);
    }
    hands.app->handle(PointerButtonChanged{PointerButton::kLeft, false, {}, at_s + 0.1});
  };
  stroke(apple, apple, 10);
  const std::size_t dabbed = hands.selected();
  REQUIRE(dabbed > 0);
  stroke(apple, orange, 10.2);
  CHECK(hands.selected() > dabbed);
}

TEST_CASE("hands: a click soon after the display changed is judged in the picture that will show it") {
  Hands hands = hands_on_sample();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const std::size_t before = hands.selected();
  hands.app.key('I');  // back to the scene; the apple alone is still on the screen
  hands.app.move(hands.app.screen_of(kOnOrange));
  hands.app.press(PointerButton::kLeft);
  hands.app.release(PointerButton::kLeft);
  CHECK(hands.selected() > before);
  CHECK(hands.studio().document().active_object()->views.front().strokes.size() == 2);
  CHECK(hands.said().find("nothing in that place") == std::string::npos);
}

TEST_CASE("hands: a click that changes nothing is a warning, with what to do") {
  Hands hands;
  const std::size_t before = hands.selected();
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.selected() == before);
  const Message& last = hands.studio().messages().back();
  CHECK(last.kind == Message::Kind::kRefused);
  CHECK_MESSAGE(last.text.find("as before: that place belonged to it already. To take more, click what") !=
                    std::string::npos,
                last.text);
  CHECK(last.text.find("nearer") == std::string::npos);
}

TEST_CASE("hands: a right click on what is not selected is told that it does not belong to the object") {
  Hands hands;
  const std::size_t before = hands.selected();
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kRight);
  REQUIRE(hands.selected() == before);
  CHECK_MESSAGE(
      hands.said().find("that place does not belong to it as it is. To remove more") != std::string::npos,
      hands.said());
}

TEST_CASE(
    "hands: right after a click + and - step its sizes, as the badges say, and Ctrl grows and shrinks") {
  CHECK(action_for('=', {}) == Action::kPartLarger);
  CHECK(action_for('=', {.shift = true}) == Action::kPartLarger);  // + on many keyboards
  CHECK(action_for('-', {}) == Action::kPartSmaller);
  CHECK(action_for('=', {.ctrl = true}) == Action::kGrow);
  CHECK(action_for('=', {.shift = true, .ctrl = true}) == Action::kGrow);
  CHECK(action_for('-', {.ctrl = true}) == Action::kShrink);
  Hands hands = hands_on_sample();
  const std::size_t apple = hands.selected();
  hands.app.key('=', {.shift = true});
  CHECK(hands.selected() > apple);
  CHECK(last_stroke(hands.studio().document().active_object()->views)->size_step == 1);
  hands.app.key('-');
  CHECK(hands.selected() == apple);
}

TEST_CASE("hands: Enter by the way is told what it is for, and all that Ctrl+A takes is counted") {
  Hands hands;
  hands.app.key(key::kEnter);
  CHECK(hands.said().find("press an arrow first") != std::string::npos);
  CHECK(hands.said().find("polygon") == std::string::npos);
  CHECK(hands.studio().messages().back().kind == Message::Kind::kInfo);
  hands.app.key('A', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.said() == "All " + gaussians_text(hands.studio().scene()->cloud->size()) +
                            " are selected. Ctrl+Z takes it back");
}

TEST_CASE("hands: what is undone and redone is named with its object where there are several") {
  Hands hands;
  const std::string first = hands.studio().document().active_object()->name;
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const std::string second = hands.studio().document().active_object()->name;
  REQUIRE(second != first);
  hands.studio().apply(ActivateObject{hands.studio().document().objects.front().id});
  const auto said_of = [&](const Command& command) {
    hands.studio().apply(command);
    REQUIRE(hands.app.settle());
    return hands.said();
  };
  const std::string undone = said_of(Undo{});
  CHECK_MESSAGE(undone.find(second) != std::string::npos, undone);
  const std::string redone = said_of(Redo{});
  CHECK_MESSAGE(redone.find(second) != std::string::npos, redone);
}
