// What is said while something is computed, of ends and leaps of sizes, and of tools that do not click.
#include <doctest/doctest.h>

#include <tuple>

#include "app/picture/cut_sentences.h"
#include "app/ui/panels.h"
#include "app/ui/stage_words.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"
#include "artist.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE(
    "words: a larger part is said to be computed until it is there, also where the object is isolated") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  const std::size_t before = count_flags(artist.labels());
  artist.app.key(key::kPageUp);
  artist.app.key('I');
  REQUIRE(artist.studio().cutting());
  CHECK(artist.said().find("computed") != std::string::npos);
  CHECK(artist.studio().messages().back().kind == Message::Kind::kInfo);
  REQUIRE(artist.app.settle());
  REQUIRE(count_flags(artist.labels()) > before);
  const auto& messages = artist.studio().messages();
  const auto result = std::ranges::find_if(
      messages, [](const Message& m) { return m.text.find(" added and ") != std::string::npos; });
  CHECK(result != messages.end());
}

TEST_CASE("words: what is isolated, hidden or framed is named") {
  Hands hands;
  Studio& studio = hands.studio();
  const ObjectId object = studio.document().active;
  studio.apply(RenameObject{object, "pot"});
  CHECK(tip_of(studio, Action::kIsolate) == "Isolate pot  (I)");
  CHECK(tip_of(studio, Action::kHide) == "Hide pot  (H)");
  CHECK(tip_of(studio, Action::kFrameObject) == "Frame pot  (F)");
  CHECK(tip_of(studio, Action::kCleanEdges) == tip_of(Action::kCleanEdges));
  CHECK(label_of({.display = DisplayMode::kIsolate}, {.name = "pot"}) == "Only pot  (I: back)");
  CHECK(label_of({.display = DisplayMode::kHide}, {.name = "pot", .filled = true}) ==
        "Without pot, its hole filled  (H: back)");
  ViewState some_hidden;
  some_hidden.hidden = {object};
  CHECK(label_of(some_hidden, {}) == "Without hidden objects  (Shift+H: back)");
  CHECK(label_of({}, {}).empty());
}

TEST_CASE("words: the lock of a part says that its whole still changes it, until that is locked, too") {
  Document document;
  add_object(&document, "pot");
  add_object(&document, "rim").within = 1;
  const auto tip = [&](ObjectId id) { return tip_of_lock(document, *document.find(id)); };
  CHECK(tip(1).find("nothing changes it, and no other") != std::string::npos);
  CHECK(tip(2).find("nothing changes it but a change of pot, of which it is a part, and") !=
        std::string::npos);
  document.find(1)->locked = true;
  CHECK(tip(2).find("nothing changes it, and no other") != std::string::npos);
}

TEST_CASE("words: a new object takes a tool that does not click to the tool Click, and no other") {
  Hands hands(false);
  hands.app.key('1');
  REQUIRE(hands.studio().view().tool == Tool::kNavigate);
  hands.app.key('N', {.ctrl = true});
  CHECK(hands.studio().view().tool == Tool::kClick);
  hands.app.key('4');
  hands.app.key('N', {.ctrl = true});
  CHECK(hands.studio().view().tool == Tool::kBox);
  hands.app.key('5');
  hands.app.key('N', {.ctrl = true});
  CHECK(hands.studio().view().tool == Tool::kBrush);
}

TEST_CASE("words: a leap of the size is said, and at the end of sizes that most of the scene is taken") {
  Artist artist(on_sample("apple", kOnApple));
  artist.click_on_it();
  artist.app.key(key::kEscape);
  std::size_t leaps = 0;
  const Clicks& clicks = artist.studio().clicks();
  REQUIRE(clicks.known_sizes());
  const auto step = [&](int code) {
    const auto before = static_cast<double>(count_flags(artist.labels()));
    const std::size_t said = artist.studio().messages().size();
    artist.app.key(code);
    REQUIRE(artist.app.settle());
    const auto after = static_cast<double>(count_flags(artist.labels()));
    bool told = false;
    for (std::size_t i = said; i < artist.studio().messages().size(); ++i)
      told |= artist.studio().messages()[i].text.find("no size between was found") != std::string::npos;
    CAPTURE(before);
    CAPTURE(after);
    CHECK(told == (after > 4 * before || 4 * after < before));
    leaps += told;
  };
  while (clicks.size_wanted() + 1 < clicks.known_sizes()->count()) step(key::kPageUp);
  CHECK(leaps > 0);
  const bool nearly_all =
      static_cast<double>(count_flags(artist.labels())) > 0.95 * static_cast<double>(artist.labels().size());
  MESSAGE(count_flags(artist.labels()), " of ", artist.labels().size(), " by ", leaps, " leaps");
  artist.app.key(key::kPageUp);
  REQUIRE(artist.said().find("This is the largest size") != std::string::npos);
  CHECK((artist.said().find("a box (4)") == std::string::npos) == nearly_all);
  CHECK((artist.said().find("nearly the whole scene") != std::string::npos) == nearly_all);
  step(key::kPageDown);
}

TEST_CASE("words: several steps at once are no leap, as there are sizes between") {
  Artist artist(on_sample("apple", kOnApple));
  artist.click_on_it();
  artist.app.key(key::kEscape);
  REQUIRE(artist.studio().clicks().known_sizes());
  for (int i = 0; i < 4; ++i) artist.app.key(key::kPageDown);
  REQUIRE(artist.app.settle());
  const auto smaller = count_flags(artist.labels());
  artist.studio().apply(StepScale{4});
  REQUIRE(artist.app.settle());
  MESSAGE(smaller, " to ", count_flags(artist.labels()));
  for (const Message& m : artist.studio().messages())
    CHECK(m.text.find("no size between") == std::string::npos);
}

TEST_CASE("words: a box that is wide but flat is said to be flat") {
  Hands hands(false);
  const Camera camera = hands.studio().viewport().pane_camera();
  hands.studio().apply(AddBox{camera, {100, 100}, {400, 102}});
  CHECK(hands.said().starts_with("The box is too flat"));
  hands.studio().apply(AddBox{camera, {100, 100}, {102, 400}});
  CHECK(hands.said().starts_with("The box is too narrow"));
  hands.studio().apply(AddBox{camera, {100, 100}, {103, 102}});
  CHECK(hands.said().starts_with("The box is too small"));
  CHECK(hands.studio().document().objects.empty());
}

TEST_CASE("words: the outline of a right click ends where the view is isolated or its background changes") {
  Hands hands = hands_on_sample();
  const auto outlined = [&] { return hands.studio().viewport().style(0).highlight != nullptr; };
  const auto point = [&](float away) {
    hands.app.move(hands.app.screen_of(kOnApple) + away);
    REQUIRE(hands.app.settle());
    hands.app.frames(2);
    REQUIRE(hands.app.settle());
  };
  const auto stays_without = [&] {
    for (int i = 0; i < 5; ++i) {
      REQUIRE(hands.app.settle());
      hands.app.frames(2);
      if (outlined()) return false;
    }
    return true;
  };
  hands.app.wait_for_message_to_go();
  point(16);
  REQUIRE(outlined());
  hands.app.key('I');
  CHECK(stays_without());
  point(-14);
  CHECK(outlined());
  hands.studio().apply(NextBackdrop{});
  CHECK(stays_without());
  point(18);
  CHECK(outlined());
}

TEST_CASE("words: why a key does nothing comes behind the key's name, not behind all that F1 says of it") {
  Hands hands(false);
  hands.studio().run(Action::kSideBySide);
  CHECK(hands.said() == "Side by side: Click an object first");
  CHECK(short_name_of(Action::kCursor) == "A cursor in the picture");
  CHECK(short_name_of(Action::kUndo) == "Undo");
}

TEST_CASE("words: nearly the whole scene is no hint to a box, nor is a leap without a step") {
  CHECK(why_no_larger(96, 100) ==
        "This is the largest size: nearly the whole scene is taken. Page Down takes less");
  CHECK(
      why_no_larger(90, 100) ==
      "This is the largest size: no larger part holds this place. Click beside it, or drag a box (4) around "
      "the thing");
  CHECK(why_one_size(1, false) ==
        "No larger part holds this place: click beside it, or drag a box (4) around the thing");
  CHECK(why_one_size(-1, false) == "No smaller part was found in it: right-click what does not belong to it");
  CHECK(why_one_size(1, true).find("larger") == std::string::npos);
  CHECK(leap_of_size(100, 401).find("no size between was found") != std::string::npos);
  CHECK(leap_of_size(401, 100) == leap_of_size(100, 401));
  CHECK(leap_of_size(100, 400).empty());
}

TEST_CASE("words: the page of keys ends at whole rows, in windows of several sizes and scrolled") {
  for (const auto& [width, height, scale] :
       {std::tuple(1280, 720, 1.0f), {2560, 1440, 2.0f}, {900, 500, 1.0f}}) {
    CAPTURE(width);
    HeadlessApp app(width, height, scale);
    app.key(key::kF1);
    app.frames(3);
    for (int scrolled = 0; scrolled < 4; ++scrolled) {
      const UiRect page = app.window("/keys_");
      REQUIRE(page.size().y > 100);
      std::size_t rows = 0;
      for (const ShownItem& item : app.interface_state().items) {
        if (item.name != "row of keys") continue;
        ++rows;
        CHECK(item.min.y >= page.min.y - 1);
        CHECK(item.max.y <= page.max.y + 1);
      }
      CHECK(rows > 15);
      app.key(key::kDown);
      app.frames(2);
    }
  }
}

TEST_CASE("words: ink on a colour is read in both themes") {
  CHECK(ink_on({0.95f, 0.71f, 0.27f, 1}) == 0xff000000u);  // the dark theme's warning
  CHECK(ink_on({0.6f, 0.37f, 0, 1}) == 0xffffffffu);       // the light theme's
}

TEST_CASE(
    "words: where a right click took something, it is not said that nothing there belongs to the object") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  artist.app.key(key::kEscape);
  const Labels mug = artist.labels();
  const Mask object = artist.shown(mug);
  std::size_t tried = 0, took = 0;
  for (int y = 40; y < object.height() - 40 && tried < 6; y += 9)
    for (int x = 60; x < object.width() - 60; ++x) {
      if (object.at(x, y) || !object.at(x + 1, y)) continue;  // beside the border: another's Gaussian is hit
      ++tried;
      const std::size_t said = artist.studio().messages().size();
      artist.click(artist.on_screen(glm::vec2(x, y) + 0.5f), PointerButton::kRight);
      const bool removed = artist.labels() != mug;
      took += removed;
      for (std::size_t i = said; removed && i < artist.studio().messages().size(); ++i) {
        const std::string& text = artist.studio().messages()[i].text;
        CHECK_MESSAGE(text.find("does not belong to it as it is") == std::string::npos, text);
      }
      artist.app.key('Z', {.ctrl = true});
      REQUIRE(artist.app.settle());
      break;
    }
  MESSAGE(took, " of ", tried, " clicks took something");
}

TEST_CASE("words: the outline that the pointer asks for while a new look is drawn comes by itself") {
  Hands hands = hands_on_sample();
  const auto outlined = [&] { return hands.studio().viewport().style(0).highlight != nullptr; };
  const glm::vec2 apple = hands.app.screen_of(kOnApple);
  const auto rests_at = [&](float away) {
    hands.app.move(apple + away);
    REQUIRE(hands.app.settle());
    hands.app.frames(2);
    REQUIRE(hands.app.settle());
  };
  hands.app.wait_for_message_to_go();
  rests_at(16);
  REQUIRE(outlined());
  SUBCASE("another background") {
    hands.studio().apply(NextBackdrop{});
  }
  SUBCASE("the checker") {
    ViewState view = hands.studio().view();
    view.checker = true;
    hands.studio().apply(SetView{view});
  }
  SUBCASE("alone") {
    ViewState view = hands.studio().view();
    view.display = DisplayMode::kIsolate;
    hands.studio().apply(SetView{view});
  }
  SUBCASE("alone, with the key") {
    hands.app.key('I');
  }
  SUBCASE("alone, while frames are drawn") {
    hands.app.key('I');
    hands.app.frames(3);
  }
  rests_at(-14);
  CHECK(outlined());
}

TEST_CASE("words: while a click is computed the window says in plain words what is done") {
  Hands hands(false);
  hands.app.click(hands.app.screen_of(kOnApple));
  std::string said;
  REQUIRE(hands.app.frames_until([&] {
    said += status_text(hands.studio()) + "\n";
    return hands.studio().idle();
  }));
  for (const char* own :
       {"first mask", "parts\n", "graph", "Working: views", "own views", "earlier strokes\n"})
    CHECK(said.find(std::string("Working: ") + own) == std::string::npos);
  CHECK(words_of_stage("first mask") == "looking for what is meant");
  CHECK(words_of_stage("exporting") == "exporting");  // says it already
}
