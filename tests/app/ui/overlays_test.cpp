// What of the scene is drawn over the picture: rings of Gaussians, the grid on the ground.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

std::size_t pixels_that_differ(const Image<Rgb8>& a, const Image<Rgb8>& b, const UiRect& within) {
  std::size_t count = 0;
  for (int y = static_cast<int>(within.min.y); y < static_cast<int>(within.max.y); ++y)
    for (int x = static_cast<int>(within.min.x); x < static_cast<int>(within.max.x); ++x)
      count += a.at(x, y) != b.at(x, y);
  return count;
}

void toggle(Studio& studio, bool ViewState::*what) {
  ViewState view = studio.view();
  view.*what = !(view.*what);
  studio.apply(SetView{view});
}

}  // namespace

TEST_CASE("overlays: rings are drawn over the picture of either renderer, and follow what is shown") {
  for (const RendererChoice renderer : {RendererChoice::kCpu, RendererChoice::kGl}) {
    CAPTURE(static_cast<int>(renderer));
    ApplicationOptions options = with_kept_scenes();
    options.renderer = renderer;
    Hands hands(true, options);
    hands.app.key('F');  // from afar splats are dots
    hands.app.move({5, kHandsHeight - 5});
    REQUIRE(hands.app.settle());
    hands.app.wait_for_message_to_go();
    const UiRect area = hands.app->interface().viewport();
    const Image<Rgb8> without = hands.app.picture();
    const auto labels = hands.studio().labels(hands.studio().document().active);
    const auto of_object = [&](const std::vector<Ring>& rings) {
      return std::ranges::all_of(rings, [&](const Ring& r) { return labels[r.gaussian] != 0; });
    };
    const RingsShown* shown = hands.app.interface_state().rings;
    toggle(hands.studio(), &ViewState::rings);
    REQUIRE(hands.app.settle());
    CHECK(pixels_that_differ(without, hands.app.picture(), area) > 500);
    CHECK(shown[0].in_view.size() > 20);
    CHECK(of_object(shown[0].in_view));
    hands.app.key('H');
    REQUIRE(hands.app.settle());
    CHECK(shown[0].in_view.size() > 20);
    CHECK(std::ranges::none_of(shown[0].in_view, [&](const Ring& r) { return labels[r.gaussian] != 0; }));
    hands.app.key('B');
    REQUIRE(hands.app.settle());
    CHECK(shown[1].in_view.size() > 20);
    CHECK(of_object(shown[1].in_view));
    hands.app.key('H', {.shift = true});
    toggle(hands.studio(), &ViewState::rings);
    REQUIRE(hands.app.settle());
    CHECK(pixels_that_differ(without, hands.app.picture(), area) == 0);
  }
}

TEST_CASE("overlays: rings and panes that went keep nothing of the scene before, with either renderer") {
  for (const RendererChoice renderer : {RendererChoice::kCpu, RendererChoice::kGl}) {
    CAPTURE(renderer == RendererChoice::kGl);
    ApplicationOptions options = with_kept_scenes();
    options.renderer = renderer;
    Hands hands(true, options);
    toggle(hands.studio(), &ViewState::rings);
    hands.app.key('B');
    REQUIRE(hands.app.settle());
    hands.app.frames(3);
    REQUIRE(hands.studio().viewport().panes() == 2);
    hands.app.key('B');
    toggle(hands.studio(), &ViewState::rings);
    REQUIRE(hands.app.settle());
    hands.app.frames(3);
    const std::weak_ptr<const GaussianCloud> before = hands.studio().scene()->cloud;
    hands.studio().apply(OpenScene{kSmallSample});
    REQUIRE(hands.app.frames_until([&] { return hands.studio().scene()->cloud != before.lock(); }));
    REQUIRE(hands.app.settle());
    hands.app.frames(3);
    CHECK(hands.app.frames_until([&] { return before.expired(); }));
  }
}

TEST_CASE("overlays: the grid shows in the window, in no picture that is saved") {
  Hands hands(false);
  hands.app.key('F', {.shift = true});
  REQUIRE(hands.app.settle());
  hands.app.wait_for_message_to_go();
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "splatcut_overlays_test";
  std::filesystem::create_directories(folder);
  const auto snapshot = [&](const char* name) {
    hands.studio().apply(SaveSnapshot{folder / name, false});
    REQUIRE(hands.app.settle());
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  hands.studio().camera().look_along(hands.studio().document().up_world * -0.4f + glm::vec3(0, 0, 1));
  REQUIRE(hands.app.settle());
  hands.app.wait_for_message_to_go();
  const Image<Rgb8> level = hands.app.picture();
  const std::string saved_level = snapshot("level.png");
  REQUIRE(saved_level.size() > 1000);
  hands.app.wait_for_message_to_go();
  toggle(hands.studio(), &ViewState::grid);
  toggle(hands.studio(), &ViewState::rings);
  REQUIRE(hands.app.settle());
  CHECK(pixels_that_differ(level, hands.app.picture(), hands.app->interface().viewport()) > 300);
  CHECK(snapshot("with.png") == saved_level);
  std::filesystem::remove_all(folder);
}

TEST_CASE("overlays: strokes fade where the object is looked at alone") {
  constexpr glm::ivec2 kOffSign{-2, -2};  // from the middle of a click's dot, beside its plus
  Hands hands(true);
  const glm::ivec2 at = glm::ivec2(hands.app.screen_of(kOnApple)) + kOffSign;
  const auto ink = [&] {
    hands.app.move({5, kHandsHeight - 5});
    REQUIRE(hands.app.settle());
    const Rgb8 pixel = hands.app.picture().at(at.x, at.y);
    return glm::ivec3(pixel[0], pixel[1], pixel[2]);
  };
  const auto far_from_ink = [&] { return glm::length(glm::vec3(ink() - glm::ivec3(90, 220, 120))); };
  CHECK(far_from_ink() < 3);
  hands.app.key('I');
  REQUIRE(hands.studio().view().tool == Tool::kClick);
  CHECK(far_from_ink() > 40);
}

TEST_CASE("overlays: the frame of a box stands in the whole scene alone") {
  Hands hands(false);
  const glm::vec2 apple = hands.app.screen_of(kOnApple);
  hands.app.key('4');
  hands.app.drag({apple - 40.0f, apple, apple + 40.0f});
  REQUIRE(hands.selected() > 0);
  REQUIRE(hands.studio().view().tool == Tool::kBox);
  const auto has_frame = [&] {
    hands.app.move({5, kHandsHeight - 5});
    REQUIRE(hands.app.settle());
    const Image<Rgb8> picture = hands.app.picture();
    int green = 0;
    for (int i = -20; i <= 20; ++i) {
      const Rgb8 p = picture.at(static_cast<int>(apple.x) - 40, static_cast<int>(apple.y) + i);
      green += p[1] > p[0] + 25 && p[1] > p[2] + 25;
    }
    return green > 30;
  };
  CHECK(has_frame());
  hands.app.key('I');
  CHECK_FALSE(has_frame());
  hands.app.key('H');
  CHECK_FALSE(has_frame());
}

TEST_CASE("overlays: the bar with a click's meanings ends within the picture of a small window") {
  HeadlessApp app(640, 480);
  app.interface_state().hint_wanted = false;
  app.open(kSmallSample);
  REQUIRE(app.settle());
  for (const glm::vec2& at : {kOnMug, kOnApple, kOnOrange}) {
    if (app.studio().clicks().offer()) break;
    app.studio().apply(NewObject{});
    app.click(app.screen_of(at));
    REQUIRE(app.settle());
  }
  REQUIRE(app.studio().clicks().offer());
  app.frames(2);
  const UiRect view = app->interface().viewport(), first = app.button("1");
  REQUIRE(first.size().x > 0);
  const float y = 0.5f * (first.min.y + first.max.y);
  CHECK_FALSE(app->interface().picture_at({first.min.x + 2, y}, app.studio()));
  CHECK(app->interface().picture_at({view.max.x - 6, y}, app.studio()));
}
