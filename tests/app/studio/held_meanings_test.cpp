// Keys 2 and 3 pressed while the first click is still computed: held until its other meanings are there.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "artist.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::vec2 kPageOfBook{360, 300}, kTwoMeaningsThere{400, 210}, kOneMeaning{670, 490};  // three there

// In the middle of its first click's computation.
struct Impatient : Artist {
  explicit Impatient(const glm::vec2& at = kPageOfBook) : Artist(on_sample("sample", at)) {
    app.click(screen_of(at));
    REQUIRE(studio().cutting());
    REQUIRE_FALSE(studio().clicks().offer());
  }
  void settle() { REQUIRE(app.settle()); }
  bool was_told(const std::string& sentence) {
    return std::ranges::any_of(studio().messages(),  // what is found later of the answer joins it
                               [&](const Message& m) { return m.text.starts_with(sentence); });
  }
};

}  // namespace

TEST_CASE("held meanings: key 2 pressed while the first click is computed takes the second one") {
  Impatient artist;
  artist.app.key('2');
  CHECK(artist.said() == "Meaning 2: as soon as Object 1 is computed");
  artist.settle();
  CHECK(artist.object().choice == 1);
  CHECK(artist.studio().clicks().offer());
  const Labels held = artist.labels();
  Artist patient(on_sample("sample", kPageOfBook));
  patient.click_on_it();
  patient.app.key('2');
  REQUIRE(patient.app.settle());
  CHECK(patient.labels() == held);
  artist.app.key('1');
  artist.settle();
  CHECK(artist.object().choice == 0);
}

TEST_CASE("held meanings: of several keys the last one counts, and 1 means the likeliest") {
  for (const bool back : {false, true}) {
    CAPTURE(back);
    Impatient artist;
    artist.app.key('2');
    artist.app.key('3');
    if (back) artist.app.key('1');
    CHECK(artist.studio().view().tool == Tool::kClick);
    artist.settle();
    CHECK(artist.object().choice == (back ? 0 : 2));
  }
}

TEST_CASE("held meanings: a key is none of a tool once the parts of the click are found, either") {
  Impatient artist;
  const ObjectId object = artist.studio().document().active;
  REQUIRE(artist.app.frames_until([&] {
    const CutRun* run = artist.studio().cuts().run(object);
    return run && run->meanings;
  }));
  artist.app.key('3');
  CHECK(artist.studio().view().tool == Tool::kClick);
  artist.settle();
  CHECK(artist.object().choice == 2);
}

TEST_CASE("held meanings: where there is no such meaning that is said") {
  Impatient artist(kTwoMeaningsThere);
  artist.app.key('3');
  artist.settle();
  CHECK(artist.was_told("Two meanings are offered: keys 1 and 2. After Esc, 3 is a tool again"));
  CHECK(artist.object().choice == 0);
  CHECK(artist.studio().view().tool == Tool::kClick);
}

TEST_CASE("held meanings: where the click has no other one that is said") {
  Impatient artist(kOneMeaning);
  artist.app.key('2');
  artist.settle();
  CHECK(artist.was_told("This click has no other meaning; the wheel right after it takes more or less"));
  CHECK(artist.studio().view().tool == Tool::kClick);
  CHECK(artist.object().choice == 0);
}

TEST_CASE("held meanings: after a click without other ones 2 and 3 are tools, and say so once") {
  Impatient artist(kOneMeaning);
  artist.settle();
  REQUIRE_FALSE(artist.studio().clicks().offer());
  SUBCASE("3 is the scribble") {
    artist.app.key('3');
    CHECK(
        artist.said() ==
        "This click has no other meaning; the wheel right after it takes more or less. The tool is Scribble "
        "now");
  }
  SUBCASE("2 is the tool that is chosen already") {
    artist.app.key('2');
    CHECK(artist.said() == "This click has no other meaning; the wheel right after it takes more or less");
  }
  SUBCASE("Esc says that none is meant") {
    artist.app.key(key::kEscape);
  }
  artist.app.key('3');
  CHECK(artist.studio().view().tool == Tool::kScribble);
}

TEST_CASE("held meanings: a click that is made again after undo offers again what Esc had declined") {
  Impatient artist;
  artist.settle();
  REQUIRE(artist.studio().clicks().offer());
  artist.app.key(key::kEscape);
  REQUIRE_FALSE(artist.studio().clicks().offer());
  artist.app.key('Z', {.ctrl = true});
  artist.settle();
  artist.app.click(artist.screen_of(kPageOfBook));
  artist.settle();
  CHECK(artist.studio().clicks().offer());
}

TEST_CASE("held meanings: a tool that ends an offer which the isolated view hides says so") {
  Impatient artist;
  artist.settle();
  REQUIRE(artist.studio().clicks().offer());
  artist.app.key('I');
  artist.settle();
  artist.app.key('2');  // the tool that is chosen already ends nothing
  CHECK(artist.said().starts_with("What else the click can mean is shown in the whole scene"));
  artist.app.key('3');
  CHECK(artist.studio().view().tool == Tool::kScribble);
  CHECK(artist.said() == "The tool is Scribble now: what else the click can mean is no longer offered");
}

TEST_CASE("held meanings: Esc, a tool and another click drop them") {
  for (const int dropped_by : {int(key::kEscape), int('4'), 0}) {
    CAPTURE(dropped_by);
    Impatient artist;
    artist.app.key('2');
    if (dropped_by != 0)
      artist.app.key(dropped_by);
    else
      artist.app.click(artist.screen_of(kPageOfBook + glm::vec2(0, 60)));
    artist.settle();
    CHECK(artist.object().choice == 0);
    CHECK(artist.said().find("eaning") == std::string::npos);
  }
}

TEST_CASE("held meanings: I and F pressed with it are of what it takes") {
  Impatient artist;
  artist.app.key('2');
  artist.app.key('I');
  artist.app.key('F');
  artist.settle();
  CHECK(artist.object().choice == 1);
  CHECK(artist.studio().view().display == DisplayMode::kIsolate);
  const CameraPose framed = artist.studio().camera().pose();
  artist.app.key('F');
  artist.settle();
  CHECK(artist.studio().camera().pose() == framed);
}

TEST_CASE("clicks: what Esc cancelled is computed once its object is chosen again, as a first click") {
  Hands hands(false);
  Studio& studio = hands.studio();
  hands.app.click(hands.app.screen_of(kOnApple));
  hands.app.key('3');
  REQUIRE(studio.cutting());
  hands.app.key(key::kEscape);
  REQUIRE(hands.said().starts_with("Cancelled. The strokes stay"));
  hands.app.key('N', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(studio.document().active == 2);
  const auto first = [&]() -> const ObjectItem& { return *studio.document().find(1); };
  CHECK(studio.gaussians_of(1) == 0);
  CHECK(studio.cuts().given_up(first()));
  studio.apply(ActivateObject{1});
  CHECK(hands.said() == "Object 1 is active");
  CHECK_FALSE(studio.cuts().given_up(first()));
  REQUIRE(hands.app.settle());
  CHECK(studio.gaussians_of(1) > 0);
  CHECK(stroke_count(first()) == 1);
  CHECK(studio.clicks().known_sizes());
}
