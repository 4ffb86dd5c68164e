// What an artist's first click can mean: the wheel and the keys choose among sizes and other meanings.
#include <doctest/doctest.h>

#include <algorithm>

#include "artist.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::vec2 kOnBook{360, 300};  // means a page of a book, or more of it

}  // namespace

TEST_CASE("clicks: the wheel takes sizes that differ, and says where there is none left without computing") {
  for (const ClickedPlace& place : with_captures({on_sample("mug", kOnMug)}, {"fox"})) {
    CAPTURE(place.name);
    Artist artist(place);
    artist.click_on_it();
    for (const float notch : {1.0f, -1.0f}) {
      std::size_t steps = 0;
      Mask before = artist.shown(artist.labels());
      for (; steps < 60; ++steps) {
        const std::size_t entries = artist.studio().history().entries().size();
        artist.app->handle(WheelTurned{notch, {}});
        artist.app.frames(1);
        if (artist.studio().history().entries().size() == entries) {
          CHECK_FALSE(artist.studio().cutting());
          break;
        }
        REQUIRE(artist.app.settle());
        CHECK(iou(before, artist.shown(artist.labels())) < 0.96);
        before = artist.shown(artist.labels());
      }
      MESSAGE(place.name, ": ", steps, " steps, then: ", artist.said());
      CHECK(steps < 60);
      const bool told = artist.said().find(notch > 0 ? "This is the largest of"
                                                     : "This is the smallest of") != std::string::npos ||
                        artist.said().find("one size alone") != std::string::npos;
      CHECK(told);
    }
  }
}

TEST_CASE("clicks: sizes are of the first click, also from another view and after a correction") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  artist.app.key(key::kPageDown);
  REQUIRE(artist.app.settle());
  const Labels smaller = artist.labels();
  artist.app.key('Z', {.ctrl = true});
  REQUIRE(artist.app.settle());
  const Labels first = artist.labels();
  REQUIRE(smaller != first);
  artist.turn(150);
  artist.app.key(key::kPageDown);
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == smaller);
  artist.app.key(key::kPageUp);
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == first);
  artist.app->handle(WheelTurned{-1, {.shift = true}});  // with Shift wherever the pointer is
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == smaller);
  artist.app.key(key::kPageUp);
  REQUIRE(artist.app.settle());
  artist.click(artist.beside(first, 30), PointerButton::kRight);
  artist.app.key(key::kPageDown);
  REQUIRE(artist.app.settle());
  CHECK(artist.object().part_step == -1);
  CHECK(iou_of(artist.labels(), smaller) > 0.95);
  const CameraPose pose = artist.studio().camera().pose();
  artist.app->handle(WheelTurned{1, {}});  // without it the wheel goes nearer
  CHECK(artist.studio().camera().pose().distance < pose.distance);
}

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

TEST_CASE("clicks: nothing is offered once more was said") {
  Artist artist(on_sample("books", kOnBook));
  artist.click_on_it();
  REQUIRE(artist.studio().clicks().offer());
  artist.click(artist.beside(artist.labels(), 25), PointerButton::kRight);
  CHECK_FALSE(artist.studio().clicks().offer());
  artist.app.key('2');
  CHECK(artist.object().choice == 0);
}

TEST_CASE("clicks: the next sizes show for a while, and are what the wheel takes") {
  Artist artist(on_sample("mug", kOnMug));
  CHECK_FALSE(artist.studio().clicks().sizes());
  artist.click_on_it();
  artist.app.key(key::kEscape);  // keeps this meaning, should others be offered
  artist.app->handle(WheelTurned{-1, {.shift = true}});
  REQUIRE(artist.app.settle());
  const ClickMeanings* sizes = artist.studio().clicks().sizes();
  REQUIRE(sizes);
  CHECK(artist.studio().clicks().sizes_opacity() == doctest::Approx(1));
  CHECK(sizes->size + 1 == sizes->likeliest_size);
  REQUIRE_FALSE(sizes->larger.empty());
  const auto mask_of = [&](const std::vector<std::vector<glm::vec2>>& borders) {
    Mask mask(sizes->camera.width_px, sizes->camera.height_px);
    for (int y = 0; y < mask.height(); ++y)
      for (int x = 0; x < mask.width(); ++x) {
        bool inside = false;
        const glm::vec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        for (const std::vector<glm::vec2>& border : borders)
          for (std::size_t i = 0; i < border.size(); ++i) {
            const glm::vec2 &a = border[i], &b = border[(i + 1) % border.size()];
            if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) * (b.x - a.x) / (b.y - a.y))
              inside = !inside;
          }
        mask.at(x, y) = inside ? kMaskObject : 0;
      }
    return mask;
  };
  const Mask larger = mask_of(sizes->larger);
  const bool had_smaller = !sizes->smaller.empty();
  const Mask smaller = had_smaller ? mask_of(sizes->smaller) : Mask();
  artist.app->handle(WheelTurned{1, {.shift = true}});
  REQUIRE(artist.app.settle());
  CHECK(iou(larger, artist.shown(artist.labels())) > 0.9);
  if (had_smaller) {
    artist.app->handle(WheelTurned{-1, {.shift = true}});
    artist.app->handle(WheelTurned{-1, {.shift = true}});
    REQUIRE(artist.app.settle());
    CHECK(iou(smaller, artist.shown(artist.labels())) > 0.8);  // the cut moves its border
  }
  REQUIRE(artist.studio().clicks().sizes());
  CHECK(artist.studio().update(0.1));  // the window goes on drawing while they fade
  artist.app->frame(1.9);
  CHECK(artist.studio().clicks().sizes_opacity() < 1);
  artist.app->frame(1);
  CHECK_FALSE(artist.studio().clicks().sizes());
  artist.app.key('I');
  artist.app->handle(WheelTurned{1, {.shift = true}});
  REQUIRE(artist.app.settle());
  CHECK_FALSE(artist.studio().clicks().sizes());  // of the object alone
}

TEST_CASE("clicks: at the ends there is no next size") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  for (const float notch : {1.0f, -1.0f}) {
    for (int i = 0; i < 60 && artist.said().find(" sizes") == std::string::npos; ++i) {
      artist.app->handle(WheelTurned{notch, {.shift = true}});
      REQUIRE(artist.app.settle());
    }
    const auto& run = *artist.studio().cuts().run(artist.object().id);
    REQUIRE(run.result);
    CHECK((notch > 0 ? run.result->larger : run.result->smaller).size() == 0);
    CHECK((notch > 0 ? run.result->smaller : run.result->larger).size() > 0);
    artist.app->handle(WheelTurned{-notch, {.shift = true}});
    REQUIRE(artist.app.settle());
  }
}
