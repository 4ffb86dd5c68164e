// What an artist meets when he clicks in the window: what was right stays, what is seen is hit, the same view
// is the same view.
#include <doctest/doctest.h>

#include <algorithm>

#include "artist.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

Labels either(const Labels& a, const Labels& b) {
  Labels out(a.size());
  for (std::size_t g = 0; g < a.size(); ++g) out[g] = a[g] || b[g];
  return out;
}

}  // namespace

TEST_CASE("clicks: a right click beside the object in a turned view takes nothing that was right") {
  for (const ClickedPlace& place : with_captures({on_sample("mug", kOnMug)})) {
    CAPTURE(place.name);
    Artist artist(place);
    artist.click_on_it();
    const Labels before = artist.labels();
    artist.turn(40);
    artist.click(artist.beside(before, 12), PointerButton::kRight);
    CHECK(artist.object().views.size() == 2);
    MESSAGE(place.name, ": ", count_flags(before), " Gaussians, lost ", lost(before, artist.labels()));
    CHECK(static_cast<double>(lost(before, artist.labels())) <
          0.01 * static_cast<double>(count_flags(before)));
  }
}

TEST_CASE("clicks: the first view reached again by its thumbnail is the first view, marks and all") {
  for (const ClickedPlace& place : with_captures({on_sample("mug", kOnMug)})) {
    CAPTURE(place.name);
    Artist artist(place);
    artist.click_on_it();
    const Labels before = artist.labels();
    const Camera first = artist.object().views.front().camera;
    artist.turn(120);
    artist.go_to(artist.run().views.front().camera);
    CHECK(same_view(artist.studio().viewport().pane_camera(), first));
    artist.app.wait_for_message_to_go();
    artist.app.move({2, 2});
    REQUIRE(artist.app.settle());
    artist.app.frames(2);
    const glm::vec2 mark = artist.on_screen(artist.object().views.front().strokes.front().points_px.front());
    const Rgb8 ink = artist.app.picture().at(static_cast<int>(mark.x + 2), static_cast<int>(mark.y - 2));
    CHECK(static_cast<int>(ink[1]) > static_cast<int>(ink[0]) + 80);  // the mark of an object click is green
    artist.click(artist.beside(before, 12), PointerButton::kRight);
    REQUIRE(artist.object().views.size() == 1);
    CHECK(same_camera(artist.object().views.front().camera, first));
    CHECK(static_cast<double>(lost(before, artist.labels())) <
          0.01 * static_cast<double>(count_flags(before)));
  }
}

TEST_CASE("clicks: an object click adds, to one thing another, and to both a third") {
  Artist artist(on_sample("apple", kOnApple));
  const Scene& scene = *artist.studio().scene()->scene;
  Labels before, truth(scene.cloud.size(), 0);
  for (const auto& [pixel, thing] : {std::pair{kOnApple, kApple}, {kOnOrange, kOrange}, {kOnMug, kMug}}) {
    artist.click(artist.screen_of(pixel));
    if (!before.empty()) {
      const auto gone = static_cast<double>(lost(before, artist.labels()));
      CHECK(gone < 0.01 * static_cast<double>(count_flags(before)));
    }
    const Labels of_thing = sample_truth(scene, thing);
    CHECK(static_cast<double>(lost(of_thing, artist.labels())) <
          0.25 * static_cast<double>(count_flags(of_thing)));
    before = artist.labels();
    truth = either(truth, of_thing);
  }
  CHECK(iou_of(before, truth) > 0.8);
}

TEST_CASE("clicks: everything under a scribble obeys it") {
  for (const ClickedPlace& place : with_captures({on_sample("mug", kOnMug)})) {
    CAPTURE(place.name);
    Artist artist(place);
    artist.click_on_it();
    for (const PointerButton button : {PointerButton::kLeft, PointerButton::kRight}) {
      const bool object = button == PointerButton::kLeft;
      CAPTURE(object);
      artist.app.key('3');
      const glm::vec2 from = artist.screen_of(place.pixel) + glm::vec2(-40, object ? 30 : 24);
      artist.app.drag({from, from + glm::vec2(40, 0), from + glm::vec2(80, 0)}, button);
      REQUIRE(artist.app.settle());
      const StrokedView& view = artist.object().views.back();
      const Image<std::uint8_t> seeds =
          draw_seeds({view.strokes.back()}, view.camera.width_px, view.camera.height_px);
      const Image<float> share = render_labels(*artist.studio().scene()->cloud,
                                               artist.studio().viewport().pane_camera(), artist.labels());
      std::size_t under = 0, obeys = 0;
      for (std::size_t i = 0; i < seeds.size(); ++i) {
        if (seeds.pixels()[i] == kNoSeed || artist.hits().pixels()[i] < 0) continue;
        ++under;
        obeys += (share.pixels()[i] >= 0.5f) == object;
      }
      MESSAGE(place.name, ": ", obeys, " of ", under, " pixels obey");
      CHECK(static_cast<double>(obeys) > 0.99 * static_cast<double>(under));
    }
  }
}

TEST_CASE("clicks: with the object hidden, hover and click hit what is seen") {
  for (const ClickedPlace& place : with_captures({on_sample("apple", kOnApple)})) {
    CAPTURE(place.name);
    Artist artist(place);
    artist.click_on_it();
    const Labels before = artist.labels();
    ViewState view = artist.studio().view();
    view.display = DisplayMode::kHide;
    artist.studio().apply(SetView{view});
    REQUIRE(artist.app.settle());
    const glm::vec2 at = artist.screen_of(place.pixel);
    const auto seen = artist.studio().viewport().pick(at - artist.on_screen({0, 0}));
    if (!seen) {  // nothing behind: refused, as everywhere
      artist.click(at);
      CHECK(artist.labels() == before);
      CHECK(artist.said().find("nothing") != std::string::npos);
      continue;
    }
    const auto hit = static_cast<std::size_t>(seen->gaussian);
    REQUIRE_FALSE(before[hit]);
    artist.app.move(at + glm::vec2(2, 0));  // nothing is outlined until the pointer moves
    artist.app.frames(1);
    artist.app.move(at);
    REQUIRE(artist.app.settle());
    const Flags outlined = artist.studio().viewport().style(0).highlight;
    REQUIRE(outlined);
    // On captures what lies at the median depth need not be of the part that shows most there.
    const bool exact = place.name == "apple";
    CHECK((exact ? (*outlined)[hit] != 0 : count_flags(*outlined) > 0));
    artist.click(at);
    CHECK(artist.labels()[hit]);
    CHECK(static_cast<double>(lost(before, artist.labels())) <=
          (exact ? 0 : 0.005) * static_cast<double>(count_flags(before)));
    // It is kept what was seen: saved and computed again, the labels are the same.
    artist.check_saved_work();
  }
}

TEST_CASE("clicks: with outlines off, hovering outlines nothing where the rest is looked at") {
  Hands hands;
  const auto outlined = [&](bool outline, DisplayMode display) {
    ViewState view = hands.studio().view();
    view.outline = outline;
    view.display = display;
    hands.studio().apply(SetView{view});
    for (const float aside_px : {2.0f, 0.0f}) {
      REQUIRE(hands.app.settle());
      hands.app.move(hands.app.screen_of(kOnOrange) + glm::vec2(aside_px, 0));
    }
    REQUIRE(hands.app.settle());
    return hands.studio().viewport().style(0).highlight != nullptr;
  };
  CHECK(outlined(true, DisplayMode::kHide));
  CHECK_FALSE(outlined(false, DisplayMode::kHide));
  CHECK(outlined(false, DisplayMode::kWhole));
}

TEST_CASE("clicks: what hovering outlines stays while the pointer rests, or comes back by itself") {
  Hands hands(true, working_ahead());
  const auto outlined = [&] { return hands.studio().viewport().style(0).highlight != nullptr; };
  for (const bool alone : {false, true}) {
    if (alone) hands.app.key('I');
    hands.app.move(hands.app.screen_of(kOnApple + glm::vec2(alone ? 23 : 25, 5)));
    REQUIRE(hands.app.settle());
    CHECK(outlined());
    for (int i = 0; i < 10; ++i) hands.app->advance(1);
    REQUIRE(hands.app.settle());  // clean edges are made meanwhile
    CHECK(outlined());
  }
}

TEST_CASE("clicks: where nothing is, a click is refused with a word and is no stroke") {
  Artist artist(on_sample("apple", kOnApple));
  ViewState view = artist.studio().view();
  view.far_share = 1e-3f;  // nothing is that near
  artist.studio().apply(SetView{view});
  REQUIRE(artist.app.settle());
  const std::size_t steps = artist.studio().history().entries().size();
  for (const PointerButton button : {PointerButton::kLeft, PointerButton::kRight}) {
    artist.click(artist.screen_of(kOnApple), button);
    CHECK(artist.said() == "There is nothing in that place. Click on something that can be seen.");
    CHECK(artist.studio().messages().back().kind == Message::Kind::kRefused);
  }
  CHECK(artist.studio().document().objects.empty());
  CHECK(artist.studio().history().entries().size() == steps);
}

TEST_CASE("clicks: hovering outlines what the click then changes, corrections included") {
  for (const ClickedPlace& place : with_captures({on_sample("apple", kOnApple)})) {
    CAPTURE(place.name);
    Artist artist(place);
    artist.click_on_it();
    const auto hovered = [&](const glm::vec2& at) {
      artist.app.move(artist.on_screen({80, 80}));  // where the last click was, its sizes are outlined
      artist.app.move(at);
      REQUIRE(artist.app.settle());
      return artist.studio().viewport().style(0).highlight ? *artist.studio().viewport().style(0).highlight
                                                           : Labels{};
    };
    glm::vec2 at = artist.beside(artist.labels(), 20);
    for (const bool rest : {false, true}) {  // adds what is there, and takes of it
      CAPTURE(rest);
      const Labels before = artist.labels();
      const Labels outlined = hovered(at);
      REQUIRE(outlined.size() == before.size());
      CHECK(artist.studio().viewport().style(0).highlight_colour ==
            (rest ? Rgb8{225, 25, 60} : Rgb8{255, 255, 255}));
      artist.click(at, rest ? PointerButton::kRight : PointerButton::kLeft);
      const Labels after = artist.labels();
      Labels changed(before.size());
      for (std::size_t g = 0; g < before.size(); ++g) changed[g] = before[g] != after[g];
      MESSAGE(place.name, ": outlined ", count_flags(outlined), ", changed ", count_flags(changed), ", IoU ",
              iou_of(outlined, changed));
      // The cut moves the border a little, which counts where little was meant.
      Labels beyond(before.size());
      for (std::size_t g = 0; g < before.size(); ++g) beyond[g] = outlined[g] != changed[g];
      const bool border = 100 * count_flags(beyond) < count_flags(before);
      CHECK((border || iou_of(outlined, changed) > 0.6));
      at = artist.inside(changed);
    }
    artist.app.move({2, 2});
    REQUIRE(artist.app.settle());
    CHECK_FALSE(artist.studio().viewport().style(0).highlight);
  }
}

TEST_CASE("clicks: beside the dot of the last click the outline is what a click there changes") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  const auto turn = [&] {
    artist.app->handle(WheelTurned{-1, {}});
    artist.app.frames(1);
    REQUIRE(artist.app.settle());
  };
  turn();  // no other meaning is offered then
  const Clicks& clicks = artist.studio().clicks();
  const auto outlined = [&] { return artist.studio().viewport().style(0).highlight; };
  REQUIRE(clicks.sizes());  // of the wheel, on the dot
  CHECK_FALSE(outlined());
  const Labels before = artist.labels();
  const glm::vec2 at = artist.screen_of(kOnMug) + glm::vec2(10, 0);
  artist.app.move(at);
  turn();  // the wheel takes the last click's sizes there, too
  CHECK(artist.labels() != before);
  artist.app.key('Z', {.ctrl = true});
  artist.app->frame(3);
  REQUIRE(artist.app.settle());
  REQUIRE(artist.labels() == before);
  CHECK_FALSE(clicks.sizes());
  REQUIRE(outlined());
  const Labels promised = *outlined();
  artist.click(at, PointerButton::kRight);
  Labels changed = artist.labels();
  for (std::size_t g = 0; g < changed.size(); ++g) changed[g] = changed[g] != before[g];
  MESSAGE("outlined ", count_flags(promised), ", changed ", count_flags(changed));
  CHECK(iou_of(promised, changed) > 0.5);  // the cut moves the border, which counts where little was meant
  artist.app.key('Z', {.ctrl = true});
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == before);
}

TEST_CASE("clicks: on the dot of the last click the wheel takes sizes in its view, elsewhere it zooms") {
  for (const bool moved : {false, true}) {
    CAPTURE(moved);
    Artist artist(on_sample("mug", kOnMug));
    artist.click_on_it();
    const auto turn_at = [&](const glm::vec2& at, float notches) {
      artist.app.move(at);
      artist.app->handle(WheelTurned{notches, {}});
      artist.app.frames(1);
      REQUIRE(artist.app.settle());
    };
    const glm::vec2 aside = artist.screen_of(kOnMug) + glm::vec2(150, -100);
    artist.app.move(aside);
    artist.app.frames(2);
    if (moved) turn_at(aside, 1);
    const Labels before = artist.labels();
    const Camera seen_from = artist.studio().viewport().pane_camera();
    REQUIRE_FALSE(artist.studio().viewport().marks().empty());
    turn_at(artist.app->interface().viewport().min + artist.studio().viewport().marks().front().at_px, -1);
    CHECK((artist.labels() == before) == moved);
    CHECK(same_camera(artist.studio().viewport().pane_camera(), seen_from) == !moved);
  }
}

TEST_CASE("clicks: what the middle of a still picture shows is prepared before the first click") {
  HeadlessApp app(kArtistWidth, kArtistHeight, 1, working_ahead());
  Studio& studio = app.studio();
  const auto take = [&](Tool tool) {
    ViewState with = studio.view();
    with.tool = tool;
    studio.apply(SetView{with});
  };
  const auto turn = [&] {
    studio.camera().orbit({200, 0});
    REQUIRE(app.settle());
  };
  app.open(kSample);
  REQUIRE(app.settle());
  CHECK(studio.neighbourhoods() == 1);
  take(Tool::kNavigate);
  turn();
  CHECK(studio.neighbourhoods() == 1);  // nobody is about to click
  take(Tool::kClick);
  REQUIRE(app.settle());
  const std::size_t ready = studio.neighbourhoods();
  CHECK(ready > 1);
  const UiRect view = app->interface().viewport();
  app.click(view.min + 0.5f * view.size());
  REQUIRE(app.settle());
  REQUIRE(studio.document().objects.size() == 1);
  CHECK(studio.neighbourhoods() == ready);
  turn();  // corrections come next
  CHECK(studio.neighbourhoods() == ready);
  studio.apply(NewObject{});
  REQUIRE(app.settle());
  CHECK(studio.neighbourhoods() > ready);
}

TEST_CASE("clicks: hovering is red while Ctrl is held, and no longer") {
  HeadlessApp app(kArtistWidth, kArtistHeight);
  REQUIRE(cut_out_apple(app));
  const auto colour_with = [&](bool ctrl) {
    app->handle(KeyChanged{key::kLeftControl, ctrl, false, {.ctrl = ctrl}});
    REQUIRE(app.settle());
    return app.studio().viewport().style(0).highlight_colour;
  };
  app.move(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  const Rgb8 adds = app.studio().viewport().style(0).highlight_colour;
  const Rgb8 removes = colour_with(true);
  CHECK(removes != adds);
  CHECK(colour_with(false) == adds);
}
