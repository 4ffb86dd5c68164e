// What is said after clicks: that something is so already, what is in doubt, what waits, what helps.
#include <doctest/doctest.h>

#include <algorithm>

#include "artist.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("clicks: what is shown as said already gets a word") {
  Artist artist(on_sample("apple", kOnApple));
  artist.click_on_it();
  const Labels before = artist.labels();
  artist.app.click(artist.screen_of(kOnApple) + glm::vec2(5, 4));
  const auto words = [&](const std::string& text) {
    return std::ranges::any_of(artist.studio().messages(),
                               [&](const Message& m) { return m.text.find(text) != std::string::npos; });
  };
  REQUIRE(artist.app.settle());
  CHECK(words("That is part of Object 1 already"));
  const bool added = artist.labels() != before;
  CHECK(words(std::string(added ? "little was missing there" : "that place belonged to it already") +
              ". To take more, click what is missing"));
  CHECK(artist.said().find("Gaussians") != std::string::npos);
  CHECK(iou_of(before, artist.labels()) > 0.99);
  artist.click(artist.beside(before, 25), PointerButton::kRight);
  CHECK(words("That is not part of Object 1 as it is"));
}

TEST_CASE("clicks: a doubt that stays is said once, and stays in the panel") {
  Artist artist(on_sample("apple", kOnApple));
  Camera farther = artist.studio().viewport().pane_camera();
  farther.camera_from_world_translation.z += 2 * artist.studio().camera().scene_size();
  artist.go_to(farther);
  artist.app.wait_for_message_to_go();
  artist.click(artist.on_screen({farther.cx_px, farther.cy_px}));
  REQUIRE(!artist.run().doubts.empty());
  const std::string doubt = artist.run().doubts.back();
  const auto said = [&] {
    return std::ranges::count_if(artist.studio().messages(),
                                 [&](const Message& m) { return m.text.find(doubt) != std::string::npos; });
  };
  REQUIRE(said() == 1);
  const Labels before = artist.labels();
  artist.click(artist.beside(before, 1));
  REQUIRE(artist.labels() != before);
  REQUIRE(artist.run().doubts.back() == doubt);
  CHECK(said() == 1);
  artist.studio().apply(OpenScene{kSample});  // another object, of the same number
  REQUIRE(artist.app.settle());
  artist.go_to(farther);
  artist.app.wait_for_message_to_go();
  const auto before_it = said();
  artist.click(artist.on_screen({farther.cx_px, farther.cy_px}));
  REQUIRE(artist.run().doubts.back() == doubt);
  CHECK(said() == before_it + 1);
}

TEST_CASE("clicks: of what is still computed nothing is said to be so already") {
  Artist artist(on_sample("apple", kOnApple));
  artist.app.click(artist.screen_of(kOnApple));
  artist.studio().apply(
      AddStroke{artist.studio().viewport().pane_camera(), {SeedLabel::kRest, 4, {{60, 60}}}});
  for (const Message& m : artist.studio().messages())
    CHECK(m.text.find("That is not part") == std::string::npos);
  REQUIRE(artist.app.settle());
}

TEST_CASE("clicks: a cut that ends after another object was begun is not said to have changed nothing") {
  Artist artist(on_sample("apple", kOnApple));
  artist.app.click(artist.screen_of(kOnApple));
  artist.studio().apply(NewObject{});
  artist.app.click(artist.screen_of(kOnOrange));
  REQUIRE(artist.app.settle());
  REQUIRE(artist.studio().document().objects.size() == 2);
  for (const Message& m : artist.studio().messages())
    CHECK_MESSAGE(m.text.find("changed nothing") == std::string::npos, m.text);
}

TEST_CASE(
    "clicks: a stroke that changed the object is not said to have changed nothing, computed twice or not") {
  Artist artist(on_sample("apple", kOnApple));
  artist.click_on_it();
  const Labels before = artist.labels();
  artist.click(artist.screen_of(kOnOrange));
  REQUIRE(artist.labels() != before);
  artist.studio().apply(Recompute{});
  REQUIRE(artist.app.settle());
  for (const Message& m : artist.studio().messages())
    CHECK(m.text.find("changed nothing") == std::string::npos);
}

TEST_CASE(
    "clicks: a box on an object that was begun before says that it added to it, one that begins says "
    "nothing") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  artist.app.key('4');
  const auto box = [&](const glm::vec2& from, const glm::vec2& to) {
    artist.app.drag({artist.app.screen_of(from), artist.app.screen_of(to)});
    REQUIRE(artist.app.settle());
    return artist.said();
  };
  CHECK(box({605, 415}, {735, 560}).find("added to Object 1, which was begun before") != std::string::npos);
  artist.app.key('N', {.ctrl = true});
  CHECK(box({720, 400}, {850, 530}).find("begun before") == std::string::npos);
  CHECK(artist.studio().document().active == 2);
}

TEST_CASE("clicks: made while others are computed, they are said to wait, and how many") {
  Artist artist(on_sample("apple", kOnApple));
  const Camera camera = artist.studio().viewport().pane_camera();
  const glm::vec2 middle = artist.studio().viewport().pane_camera().pixel_from_camera({0, 0, 1});
  const auto said_after = [&](SeedLabel label, float right) {
    artist.studio().apply(AddStroke{camera, {label, 4, {middle + glm::vec2(right, 0)}}});
    return artist.said();
  };
  CHECK(said_after(SeedLabel::kObject, 0).find("wait") == std::string::npos);
  CHECK(said_after(SeedLabel::kRest, 30).find("2 strokes wait") != std::string::npos);
  CHECK(said_after(SeedLabel::kRest, 60).find("3 strokes wait") != std::string::npos);
  REQUIRE(artist.app.settle());
  CHECK(said_after(SeedLabel::kRest, -30).find("wait") == std::string::npos);
  REQUIRE(artist.app.settle());
}

TEST_CASE("clicks: after a second right click that took little, a scribble is advised, once") {
  Artist artist(on_sample("apple", kOnApple));
  artist.click_on_it();
  int in_a_row = 0, advised = 0;
  // Four of them take little, one takes more, and two little again.
  for (const glm::vec2& by :
       {glm::vec2(24, 20), {-26, 18}, {2, 34}, {28, -4}, {-28, -8}, {24, 26}, {-22, 28}}) {
    const Labels before = artist.labels();
    artist.click(artist.screen_of(kOnApple) + by, PointerButton::kRight);
    const Labels after = artist.labels();
    std::ptrdiff_t changed = 0;
    for (std::size_t g = 0; g < after.size(); ++g) changed += before[g] != after[g];
    CAPTURE(changed);
    in_a_row = 50 * changed < std::ranges::count(after, 1) ? in_a_row + 1 : 0;
    const bool said = artist.said().find("with Scribble (3) hold the right button") != std::string::npos;
    CAPTURE(artist.said());
    if (changed > 0) CHECK(said == (in_a_row == 2));
    advised += said;
  }
  CHECK(advised > 0);
}
