// What else a first click can mean: offered, chosen by keys, withdrawn.
#include <doctest/doctest.h>

#include "artist.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::vec2 kOnBook{360, 300};  // means a page of a book, or more of it
constexpr glm::vec2 kOfTwoMeanings{400, 210};

}  // namespace

TEST_CASE("clicks: other meanings of the first click are offered, chosen by keys, undone and saved") {
  Artist artist(on_sample("books", kOnBook));
  artist.click_on_it();
  const ClickMeanings* offer = artist.studio().clicks().offer();
  REQUIRE(offer);
  MESSAGE(offer->outlines.size(), " meanings");
  REQUIRE(offer->outlines.size() >= 2);
  const Labels first = artist.labels();
  artist.app.key('2');
  REQUIRE(artist.app.settle());
  const Labels second = artist.labels();
  CHECK(artist.object().choice == 1);
  CHECK(artist.studio().view().tool == Tool::kClick);
  CHECK(iou_of(first, second) < 0.9);
  REQUIRE(artist.studio().clicks().offer());  // it can still be changed
  artist.app.key('Z', {.ctrl = true});
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == first);
  artist.app.key('2');
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == second);

  CHECK(artist.object().choice == 1);
  artist.check_saved_work();

  artist.app.key('1');
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == first);
  artist.app.key(key::kEscape);
  CHECK_FALSE(artist.studio().clicks().offer());
  CHECK(artist.studio().view().tool == Tool::kClick);
  artist.app.key('3');  // a tool again
  CHECK(artist.studio().view().tool == Tool::kScribble);
}

TEST_CASE("clicks: where two meanings are offered, key 3 takes no tool, and key 4 is the box") {
  Artist artist(on_sample("sample", kOfTwoMeanings));
  artist.click_on_it();
  const Clicks& clicks = artist.studio().clicks();
  REQUIRE(clicks.offer());
  REQUIRE(clicks.offer()->outlines.size() == 2);
  artist.app.key('3');
  CHECK(artist.said() == "Two meanings are offered: keys 1 and 2. After Esc, 3 is a tool again");
  CHECK(artist.studio().view().tool == Tool::kClick);
  CHECK(artist.object().choice == 0);
  artist.app.key('2');
  REQUIRE(artist.app.settle());
  CHECK(artist.object().choice == 1);
  artist.app.key('4');
  CHECK(artist.studio().view().tool == Tool::kBox);
  CHECK_FALSE(clicks.offer());
}

TEST_CASE("clicks: another tool chosen while the click is computed ends the offer that comes, too") {
  Artist artist(on_sample("books", kOnBook));
  artist.app.click(artist.screen_of(kOnBook));
  REQUIRE(artist.studio().cutting());
  artist.app.key('4');
  artist.app.key('3');
  CHECK(artist.studio().view().tool == Tool::kScribble);
  REQUIRE(artist.studio().cutting());
  artist.app.key('2');
  CHECK(artist.studio().view().tool == Tool::kClick);
  REQUIRE(artist.app.settle());
  CHECK(artist.object().choice == 0);
  CHECK_FALSE(artist.studio().clicks().offer());
}

TEST_CASE("clicks: Esc that leaves the object alone keeps the meaning that it has") {
  Artist artist(on_sample("books", kOnBook));
  artist.click_on_it();
  const Clicks& clicks = artist.studio().clicks();
  REQUIRE(clicks.offer());
  artist.app.key('I');
  artist.app.key('I');
  CHECK(clicks.offer());  // it was a look at the object
  artist.app.key('I');
  REQUIRE(artist.app.settle());
  artist.app.key(key::kEscape);
  CHECK(artist.studio().view().display == DisplayMode::kWhole);
  CHECK_FALSE(clicks.offer());
  artist.app.key('3');
  CHECK(artist.studio().view().tool == Tool::kScribble);
}

TEST_CASE("clicks: Esc that cancels the cut of a meaning ends the offer, too") {
  Artist artist(on_sample("books", kOnBook));
  artist.click_on_it();
  const Clicks& clicks = artist.studio().clicks();
  REQUIRE(clicks.offer());
  artist.app.key('2');
  REQUIRE(artist.studio().cutting());
  artist.app.key(key::kEscape);
  REQUIRE(artist.app.settle());
  REQUIRE(artist.said().starts_with("Cancelled"));
  CHECK_FALSE(clicks.offer());
  artist.app.key('3');
  CHECK(artist.studio().view().tool == Tool::kScribble);
  artist.app.key('2');
  CHECK(artist.studio().view().tool == Tool::kClick);
}

TEST_CASE("clicks: nothing is offered for an object of which all was deleted, until that is undone") {
  Artist artist(on_sample("books", kOnBook));
  artist.click_on_it();
  const Clicks& clicks = artist.studio().clicks();
  REQUIRE(clicks.offer());
  artist.app.key(key::kDelete);
  REQUIRE(artist.app.settle());
  REQUIRE(artist.studio().gaussians_of(artist.object().id) == 0);
  CHECK_FALSE(clicks.offer());
  CHECK_FALSE(clicks.sizes());
  artist.app.key('2');
  CHECK(artist.object().choice == 0);
  artist.studio().apply(Undo{});
  REQUIRE(artist.app.settle());
  REQUIRE(artist.studio().gaussians_of(artist.object().id) > 0);
  artist.app.key('2');  // the tool, if it was left
  CHECK(clicks.offer());
}

TEST_CASE("clicks: nothing is offered once more was said") {
  Artist artist(on_sample("books", kOnBook));
  artist.click_on_it();
  REQUIRE(artist.studio().clicks().offer());
  artist.click(artist.beside(artist.labels(), 25), PointerButton::kRight);
  CHECK_FALSE(artist.studio().clicks().offer());
  artist.app.key('2');
  CHECK(artist.object().choice == 0);
}
