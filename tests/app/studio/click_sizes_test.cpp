// Sizes of what a click means: by the wheel, by keys, by the slider, and cut ahead.
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "artist.h"

using namespace splatcut;
using namespace splatcut::testing;

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
      const bool told =
          artist.said().starts_with(notch > 0 ? "This is the largest size" : "This is the smallest size") ||
          artist.said().starts_with(notch > 0 ? "No larger part holds" : "No smaller part was found");
      CHECK(told);
    }
  }
}

TEST_CASE("clicks: at the ends of what a right click takes away, that is said") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  artist.app.click(artist.screen_of(kOnMug + glm::vec2(0, 55)), PointerButton::kRight);
  REQUIRE(artist.app.settle());
  for (const int key : {int(key::kPageUp), int(key::kPageDown)}) {
    std::size_t entries = 0;
    for (int steps = 0; steps < 60 && artist.studio().history().entries().size() != entries; ++steps) {
      entries = artist.studio().history().entries().size();
      artist.app.key(key);
      REQUIRE(artist.app.settle());
    }
    const char* end = key == key::kPageUp ? "takes no more away than this" : "takes no less away than this";
    CHECK_MESSAGE(artist.said().find(end) != std::string::npos, artist.said());
  }
}

TEST_CASE("clicks: sizes of a right click are worded as what is taken away") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  const auto step = [&](const char* title, const std::string& computing) {
    const auto& entries = artist.studio().history().entries();
    const int steps = std::string(title).find("more") != std::string::npos || *title == 'L' ? 1 : -1;
    artist.studio().apply(StepScale{steps});
    CHECK(entries[artist.studio().history().cursor()].title == title);
    CHECK_MESSAGE(artist.said() == computing, artist.said());
    REQUIRE(artist.app.settle());
  };
  step("Larger part", "A larger part is being computed");
  step("Smaller part", "A smaller part is being computed");
  artist.app.click(artist.screen_of(kOnMug + glm::vec2(0, 55)), PointerButton::kRight);
  REQUIRE(artist.app.settle());
  const StrokeSizes* sizes = artist.studio().clicks().known_sizes();
  REQUIRE(sizes);
  REQUIRE(sizes->count() > 1);
  if (sizes->size + 1 < sizes->count()) {
    step("Takes more away", "A larger part to take away is being computed");
    step("Takes less away", "A smaller part to take away is being computed");
  } else {
    step("Takes less away", "A smaller part to take away is being computed");
    step("Takes more away", "A larger part to take away is being computed");
  }
}

TEST_CASE("clicks: sizes are of the last click, also from another view and of a correction") {
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

  // A right click on the mug: the wheel takes less or more of it, undo goes back step by step.
  const glm::vec2 on_it = artist.inside(first);
  Labels corrected;
  glm::vec2 clicked(0);
  const StrokeSizes* sizes = nullptr;
  for (const glm::vec2& away : {glm::vec2(-30, 0), {30, 0}, {0, -30}, {0, 30}}) {  // not all have two sizes
    clicked = on_it + away;
    artist.click(clicked, PointerButton::kRight);
    corrected = artist.labels();
    sizes = artist.studio().clicks().known_sizes();
    if (sizes && sizes->count() > 1 && count_flags(corrected) < count_flags(first)) break;
    artist.app.key('Z', {.ctrl = true});
    REQUIRE(artist.app.settle());
    sizes = nullptr;
  }
  REQUIRE(sizes);
  artist.app->frame(5);
  CHECK(artist.studio().clicks().sizes() == sizes);  // shown, as the wheel takes them
  CHECK_FALSE(artist.studio().viewport().style(0).highlight);
  CHECK_FALSE(artist.studio().clicks().sizes_fade());
  const int notch = sizes->size + 1 < sizes->count() ? 1 : -1;
  artist.app->handle(WheelTurned{static_cast<float>(notch), {}});
  REQUIRE(artist.app.settle());
  CHECK(last_stroke(artist.object().views)->size_step == notch);
  CHECK(first_stroke(artist.object().views)->size_step == 0);
  CHECK((count_flags(artist.labels()) < count_flags(corrected)) == (notch > 0));
  artist.check_saved_work();
  artist.app.key('Z', {.ctrl = true});
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == corrected);
  const CameraPose pose = artist.studio().camera().pose();
  artist.app.move(artist.on_screen({80, 80}));
  artist.app.move(clicked);  // back on its dot
  artist.app->handle(WheelTurned{static_cast<float>(notch), {}});
  REQUIRE(artist.app.settle());
  CHECK(last_stroke(artist.object().views)->size_step == notch);
  CHECK(artist.studio().camera().pose() == pose);
  artist.app.key('Z', {.ctrl = true});
  REQUIRE(artist.app.settle());
  artist.app.move(artist.on_screen({80, 80}));
  artist.app->handle(WheelTurned{1, {}});  // elsewhere the wheel goes nearer
  CHECK(artist.studio().camera().pose().position_world != pose.position_world);
}

TEST_CASE(
    "clicks: sizes of a click that was made after a right click beside it; one without sizes lets the wheel "
    "zoom") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click(artist.on_screen({80, 80}), PointerButton::kRight);
  const float distance = artist.studio().camera().pose().distance;
  artist.app->handle(WheelTurned{1, {}});
  CHECK(artist.studio().camera().pose().distance != distance);
  artist.app->handle(WheelTurned{-1, {}});
  REQUIRE(artist.app.settle());
  artist.click_on_it();
  const Labels first = artist.labels();
  REQUIRE(artist.studio().clicks().known_sizes());
  CHECK(artist.studio().clicks().known_sizes()->count() > 3);
  artist.app->handle(WheelTurned{-1, {}});
  REQUIRE(artist.app.settle());
  CHECK(count_flags(artist.labels()) < count_flags(first));
}

TEST_CASE("clicks: the next sizes show as long as the wheel takes them, and for a while") {
  Artist artist(on_sample("mug", kOnMug));
  CHECK_FALSE(artist.studio().clicks().sizes());
  artist.click_on_it();
  artist.app.key(key::kEscape);  // keeps this meaning, should others be offered
  // Not until everything is looked at: on a slow machine they have faded by then.
  const auto turn = [&](float notch) {
    artist.app->handle(WheelTurned{notch, {.shift = true}});
    artist.app.frames(1);
    REQUIRE(artist.app.frames_until([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // a frame is a sixtieth of a second
      return artist.studio().cuts().cutting() == 0;
    }));
  };
  turn(-1);
  const StrokeSizes* sizes = artist.studio().clicks().sizes();
  REQUIRE(sizes);
  CHECK(artist.studio().clicks().sizes_opacity() == doctest::Approx(1));
  CHECK(sizes->size + 1 == sizes->likeliest);
  REQUIRE(sizes->size + 1 < sizes->count());
  const auto mask_of = [&](const Borders& borders) {
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
  const Mask larger = mask_of(sizes->outlines[sizes->size + 1]);
  const bool had_smaller = sizes->size > 0;
  const Mask smaller = had_smaller ? mask_of(sizes->outlines[sizes->size - 1]) : Mask();
  turn(1);
  CHECK(iou(larger, artist.shown(artist.labels())) > 0.9);
  if (had_smaller) {
    turn(-1);
    turn(-1);
    CHECK(iou(smaller, artist.shown(artist.labels())) > 0.8);  // the cut moves its border
  }
  REQUIRE(artist.studio().clicks().sizes());
  artist.app.move(artist.on_screen({80, 80}));
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
    for (int i = 0; i < 60 && artist.said().find("est size") == std::string::npos; ++i) {
      artist.app->handle(WheelTurned{notch, {.shift = true}});
      REQUIRE(artist.app.settle());
    }
    const auto& run = *artist.studio().cuts().run(artist.object().id);
    REQUIRE(run.result);
    CHECK(run.result->size == (notch > 0 ? run.result->sizes - 1 : 0));
    artist.app->handle(WheelTurned{-notch, {.shift = true}});
    REQUIRE(artist.app.settle());
  }
}

TEST_CASE("clicks: a step of the size shows its outline at once and is computed after it, numbers agree") {
  Artist artist(on_sample("mug", kOnMug));
  CHECK_FALSE(artist.studio().clicks().known_sizes());
  artist.click_on_it();
  const Clicks& clicks = artist.studio().clicks();
  REQUIRE(clicks.known_sizes());
  const std::size_t size = clicks.known_sizes()->size, sizes = clicks.known_sizes()->count();
  REQUIRE(size >= 2);
  CHECK(clicks.size_wanted() == size);
  CHECK(artist.run().result->sizes == sizes);
  const Borders coming = clicks.known_sizes()->outlines[size - 2];
  artist.app.key(key::kPageDown);
  artist.app.key(key::kPageDown);
  REQUIRE(artist.studio().cutting());
  REQUIRE(clicks.sizes());  // before anything is computed
  CHECK(clicks.size_wanted() == size - 2);
  CHECK(clicks.sizes()->outlines[size - 2] == coming);
  CHECK(clicks.sizes_opacity() == 1);
  REQUIRE(artist.app.settle());
  CHECK(clicks.known_sizes()->size == size - 2);
  CHECK(clicks.known_sizes()->count() == sizes);
  CHECK(artist.run().result->size == size - 2);
  while (artist.said().find("est size") == std::string::npos) {
    artist.app.key(key::kPageDown);
    REQUIRE(artist.app.settle());
  }
  CHECK(artist.said().find("smallest size: right-click") != std::string::npos);
  CHECK(clicks.size_wanted() == 0);
  CHECK(clicks.known_sizes()->size == 0);
  CHECK(clicks.known_sizes()->count() == sizes);
}

TEST_CASE(
    "clicks: the sizes next to the one taken are cut while nothing is done, and are there when asked for") {
  Artist artist(on_sample("mug", kOnMug), working_ahead());
  artist.click_on_it();
  const CutJobs& cuts = artist.studio().cuts();
  REQUIRE(artist.studio().clicks().known_sizes()->size >= 3);
  for (const int step : {key::kPageDown, key::kPageUp, key::kPageUp, key::kPageDown}) {
    CAPTURE(step);
    const std::uint64_t done = cuts.done();
    const Flags before = artist.object().cut;
    artist.app.key(step);
    REQUIRE(cuts.done() == done + 1);  // before anything else is done
    CHECK(cuts.cutting() == 0);
    CHECK(*artist.object().cut != *before);
    CHECK(artist.studio().clicks().known_sizes()->size == artist.studio().clicks().size_wanted());
    CHECK(artist.run().result->labels == *artist.object().cut);
    REQUIRE(artist.app.settle());
    CHECK(artist.run().views.size() > 1);  // looked around as after any cut
    artist.check_saved_work();             // to the bit what is computed without the window
  }

  // Computed anew where that is asked for, whatever is known.
  const Labels was = artist.labels();
  artist.studio().apply(Recompute{});
  CHECK(artist.studio().cutting());
  REQUIRE(artist.app.settle());
  CHECK(artist.labels() == was);
}

TEST_CASE("clicks: what is cut ahead makes way for a click, which comes out as if it had been alone") {
  Artist artist(on_sample("mug", kOnMug), working_ahead());
  const auto cuts_ahead = [&] {
    const TaskThread::Progress progress = artist.studio().progress();
    return progress.kind == TaskKind::kAhead && !progress.stage.empty();
  };
  artist.app.click(artist.screen_of(kOnMug));
  for (int frame = 0; frame < 100'000 && !cuts_ahead(); ++frame) artist.app.frames(1);
  REQUIRE(cuts_ahead());
  CHECK_FALSE(artist.studio().progress().busy);  // nobody waits for it
  artist.app.click(artist.screen_of(kOnMug) + glm::vec2(0, -40), PointerButton::kRight);
  REQUIRE(artist.app.settle());
  CHECK(stroke_count(artist.object()) == 2);
  artist.check_saved_work();
}

TEST_CASE("clicks: the slider of sizes outlines the step under the pointer, and takes it when it is let go") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  artist.app.wait_for_message_to_go();
  const Clicks& clicks = artist.studio().clicks();
  const UiState& state = artist.app.interface_state();
  const UiRect panel = artist.app.window("side/scroll");
  // Down the panel until the pointer is at the slider.
  glm::vec2 at(panel.max.x - 60, panel.min.y + 2);
  for (; at.y < panel.max.y && !state.size_pointed; at.y += 6) {
    artist.app.move(at);
    artist.app.frames(2);
  }
  REQUIRE(state.size_pointed);
  CHECK(2 * *state.size_pointed > clicks.known_sizes()->count());  // near the right end
  const Image<Rgb8> large = artist.app.picture();
  std::size_t before = *state.size_pointed;
  while (*state.size_pointed > 1) {
    at.x -= 1;
    artist.app.move(at);
    artist.app.frames(2);
    REQUIRE(state.size_pointed);
    CHECK(*state.size_pointed <= before);
    CHECK(before - *state.size_pointed <= 1);
    before = *state.size_pointed;
  }
  CHECK(large != artist.app.picture());
  CHECK_FALSE(artist.studio().cutting());  // nothing is computed for a look
  artist.click(at);
  CHECK(clicks.known_sizes()->size == 1);
  CHECK(clicks.size_wanted() == 1);
  artist.app.move(artist.on_screen({80, 80}));
  artist.app.frames(2);
  CHECK_FALSE(state.size_pointed);
}

TEST_CASE("clicks: a smaller part is one of the sizes that the click had, however small it is") {
  HeadlessApp app(1280, 720);
  app.open(kSample);
  REQUIRE(app.settle());
  app.click({537, 446});  // the mug, whose smaller parts are looked at with more pixels
  REQUIRE(app.settle());
  const Clicks& clicks = app.studio().clicks();
  REQUIRE(clicks.known_sizes());
  const StrokeSizes first = *clicks.known_sizes();
  REQUIRE(first.size >= 3);
  for (std::size_t i = 1; i <= 3; ++i) {
    app.key(key::kPageDown);
    REQUIRE(app.settle());
    REQUIRE(clicks.known_sizes());
    CHECK(clicks.known_sizes()->count() == first.count());
    CHECK(clicks.known_sizes()->size + i == first.size);
  }
}

TEST_CASE("clicks: the step that the slider was pointed at is none of an object with fewer") {
  Artist artist(on_sample("apple", kOnApple));
  artist.click_on_it();
  artist.app.interface_state().size_pointed = artist.studio().clicks().known_sizes()->count() + 4;
  artist.app.frames(1);  // an undo while the pointer rests on the slider
  CHECK_FALSE(artist.app.interface_state().size_pointed);
}

TEST_CASE("clicks: what is said of the wheel fits what the click changed") {
  Artist artist(on_sample("mug", kOnMug));
  artist.click_on_it();
  artist.app.key(key::kEscape);
  const glm::vec2 middle = artist.screen_of(kOnMug);
  artist.click(middle + glm::vec2(14, -4), PointerButton::kRight);
  std::size_t little = 0, much = 0, said = artist.studio().messages().size();
  for (const glm::vec2& away : {glm::vec2(-8, -8), {-30, 10}, {6, -25}, {-11, 0}, {5, 9}, {30, 40}}) {
    const Labels before = artist.labels();
    const auto is_part = artist.studio().viewport().pick(middle + away - artist.on_screen({0, 0}));
    REQUIRE(is_part);
    const bool rest = before[static_cast<std::size_t>(is_part->gaussian)] != 0;
    artist.click(middle + away, rest ? PointerButton::kRight : PointerButton::kLeft);
    const Labels after = artist.labels();
    std::size_t changed = 0;
    for (std::size_t g = 0; g < after.size(); ++g) changed += before[g] != after[g];
    const bool is_little = 50 * changed < count_flags(after);
    for (; said < artist.studio().messages().size(); ++said) {
      const std::string& text = artist.studio().messages()[said].text;
      if (text.find(" removed in ") == std::string::npos) continue;
      CAPTURE(text);
      (is_little ? little : much) += 1;
      if (is_little) CHECK(text.find(" less") == std::string::npos);
      CHECK(text.find('?') == std::string::npos);  // a good click is put in no doubt
    }
  }
  CHECK(little >= 1);
  MESSAGE(little, " clicks changed little, ", much, " much");
}

namespace {

// Object 1 has all but the mug, which is clicked for object 2: no size of that gives it more.
void click_mug_where_another_has_the_rest(Artist& artist) {
  artist.click_on_it();
  artist.studio().run(Action::kInvert);
  REQUIRE(artist.app.settle());
  artist.studio().apply(NewObject{});
  artist.click_on_it();
  artist.app.key(key::kEscape);
  REQUIRE(artist.app.settle());
  REQUIRE(artist.object().id == 2);
}

}  // namespace

TEST_CASE("clicks: outlines of sizes lead around what other objects keep") {
  Artist artist(on_sample("mug", kOnMug));
  click_mug_where_another_has_the_rest(artist);
  const StrokeSizes* sizes = artist.studio().clicks().known_sizes();
  REQUIRE(sizes);
  REQUIRE(sizes->size + 2 < sizes->count());
  glm::vec2 low(1e9f), high(-1e9f);
  for (const Borders& borders : sizes->outlines)
    for (const std::vector<glm::vec2>& border : borders)
      for (const glm::vec2& point : border) {
        low = glm::min(low, point);
        high = glm::max(high, point);
      }
  const PixelRect mug = bounds(artist.shown(artist.labels()));
  constexpr float kBlurPx = 6;  // they are found in smaller pictures
  CHECK(low.x > static_cast<float>(mug.x0) - kBlurPx);
  CHECK(low.y > static_cast<float>(mug.y0) - kBlurPx);
  CHECK(high.x < static_cast<float>(mug.x1) + kBlurPx);
  CHECK(high.y < static_cast<float>(mug.y1) + kBlurPx);

  // With what the others keep given back, as far as the sizes reach.
  const float width = high.x - low.x;
  artist.studio().apply(LeaveToOthers{2, false});
  artist.app.key(key::kPageUp);
  artist.app.key(key::kPageUp);
  REQUIRE(artist.app.settle());
  sizes = artist.studio().clicks().known_sizes();
  REQUIRE(sizes);
  float left = 1e9f, right = -1e9f;
  for (const glm::vec2& point : sizes->outlines.back().front()) {
    left = std::min(left, point.x);
    right = std::max(right, point.x);
  }
  CHECK(right - left > 1.5f * width);
}

TEST_CASE("clicks: of a size that changes nothing that is said, and one that is known to be such is passed") {
  for (const bool ahead : {false, true}) {
    CAPTURE(ahead);
    Artist artist(on_sample("mug", kOnMug), ahead ? working_ahead() : with_kept_scenes());
    artist.click_on_it();
    artist.app.key(key::kEscape);
    for (int i = 0; i < 2; ++i) {  // then hands have said of each Gaussian whose it is
      artist.studio().run(Action::kInvert);
      REQUIRE(artist.app.settle());
    }
    const Clicks& clicks = artist.studio().clicks();
    const Labels before = artist.labels();
    const std::size_t first = clicks.size_wanted(), last = clicks.known_sizes()->count() - 1;
    REQUIRE(first + 2 <= last);
    const auto step = [&](int key) {
      artist.app.key(key);
      REQUIRE(artist.app.settle());
      CHECK(artist.labels() == before);
    };
    step(key::kPageUp);
    CHECK(clicks.size_wanted() == first + (ahead ? 2 : 1));
    CHECK(artist.said().ends_with("as before: this size changes nothing here"));
    CHECK(artist.studio().messages().back().kind == Message::Kind::kInfo);
    const std::size_t size = clicks.size_wanted();
    step(key::kPageDown);  // past all that are known to be the same
    CHECK(clicks.size_wanted() + (ahead ? 3 : 2) <= size);
    while (clicks.size_wanted() < last && !artist.said().starts_with("This is the largest size"))
      step(key::kPageUp);
    step(key::kPageUp);
    CHECK(artist.said().starts_with("This is the largest size"));
  }
}
