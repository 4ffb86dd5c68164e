// Gaussians selected by hand: by brush, polygon, rectangle, colour and size, and which of them a region
// takes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/document/selection.h"
#include "hands.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: the eyedropper and the flood say where there is nothing to go by") {
  Hands hands = hands_on_sample();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const std::size_t steps = hands.studio().history().entries().size();
  for (const int tool : {'C', 'G'}) {
    hands.app.key(tool);
    hands.app.click(hands.app.screen_of(kOnMug));  // the apple is alone
    REQUIRE(hands.app.settle());
    CHECK(hands.said().starts_with("There is nothing in that place"));
  }
  CHECK(hands.studio().history().entries().size() == steps);
}

TEST_CASE("hands: the eyedropper takes one colour everywhere, the flood where it hangs together") {
  Hands hands = hands_on_sample(false);
  REQUIRE(hands.app.settle());
  const Scene& scene = *hands.studio().scene()->scene;
  hands.app.key('C');
  REQUIRE(hands.studio().view().tool == Tool::kColour);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto by_colour = hands.studio().labels(hands.studio().document().active);
  hands.app.key('G');
  hands.studio().apply(EditSelection{SelectionEdit::kNone});
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto flooded = hands.studio().labels(hands.studio().document().active);
  const auto orange = sample_truth(scene, kOrange);
  std::size_t beyond = 0, of_orange = 0;
  for (std::size_t g = 0; g < flooded.size(); ++g) {
    beyond += flooded[g] && !by_colour[g];
    of_orange += flooded[g] && orange[g];
  }
  MESSAGE(count_flags(by_colour), " by colour, ", count_flags(flooded), " by flood, ", of_orange,
          " of the orange");
  CHECK(count_flags(flooded) > 100);
  CHECK(beyond == 0);
  CHECK(static_cast<double>(of_orange) > 0.8 * static_cast<double>(count_flags(flooded)));
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kLeft, {.ctrl = true});
  CHECK(hands.selected() == 0);
}

TEST_CASE("hands: eyedropper and flood outline what a click there changes before it is made") {
  Hands hands = hands_on_sample(false);
  const glm::vec2 on_orange = hands.app.screen_of(kOnOrange);
  for (const int key : {'C', 'G'}) {
    CAPTURE(static_cast<char>(key));
    hands.app.key(key);
    hands.studio().apply(EditSelection{SelectionEdit::kNone});
    for (const Modifiers& held : {Modifiers{}, Modifiers{.ctrl = true}}) {
      CAPTURE(held.ctrl);
      hands.app.move(on_orange, held);
      REQUIRE(hands.app.settle());
      const Flags outlined = hands.studio().viewport().style(0).highlight;
      const std::size_t before = hands.selected();
      REQUIRE(outlined);
      hands.app.click(on_orange, PointerButton::kLeft, held);
      const std::size_t after = hands.selected();
      CHECK(count_flags(*outlined) == (held.ctrl ? before - after : after - before));
      hands.app.move(on_orange + glm::vec2(60, -150));
    }
  }
  hands.app.key('2');
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() == 0);
}

TEST_CASE("hands: Enter closes a polygon whatever key is held, and does what its corners were clicked with") {
  for (const Modifiers held :
       {Modifiers{}, Modifiers{.shift = true}, Modifiers{.ctrl = true}, Modifiers{.alt = true}}) {
    Hands hands(false);
    hands.studio().apply(EditSelection{SelectionEdit::kAll});
    const std::size_t all = hands.selected();
    hands.app.key('8');
    const glm::vec2 at = hands.app.screen_of(kOnApple);
    for (const glm::vec2& corner : {at - 60.0f, at + glm::vec2(60, -60), at + 60.0f})
      hands.app.click(corner, PointerButton::kLeft, {.ctrl = true});
    REQUIRE(hands.studio().overlay().dots);
    hands.app.key(key::kEnter, held);
    REQUIRE(hands.app.settle());
    CHECK(hands.studio().overlay().points_px.empty());
    CHECK(hands.selected() < all);
    CHECK(hands.selected() > all / 2);
  }
}

TEST_CASE("hands: the ends of a range take all beyond them, and what is in it shows before it is taken") {
  HeadlessApp app(900, 1000);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const auto selected = [&] {
    REQUIRE(app.settle());
    return app.studio().gaussians_of(app.studio().document().active);
  };
  app.press_item("side/scroll", {"Repair by hand"});
  app.press_item("side/scroll", {"Size"});
  const GaussianCloud& cloud = app.studio().scene()->scene->cloud;
  const std::vector<float> sizes = property_values(cloud, Property::kSize);
  PropertyChoice& choice = app.interface_state().property;
  const float largest = *std::ranges::max_element(sizes);
  REQUIRE(largest > choice.histogram.high);  // outliers are beyond the histogram
  choice.low = 0.5f * (choice.histogram.low + choice.histogram.high);
  const std::size_t in_range =
      static_cast<std::size_t>(std::ranges::count_if(sizes, [&](float s) { return s >= choice.low; }));
  app.frames(2);
  const UiRect add = app.button("Add");
  app.move(0.5f * (add.min + add.max));
  REQUIRE(app.settle());
  const Flags shown = app.studio().viewport().style(0).highlight;
  REQUIRE(shown);
  CHECK(count_flags(*shown) == in_range);
  CHECK(selected() == 0);
  app.move({300, 300});
  app.frames(2);
  REQUIRE(app.settle());
  CHECK_FALSE(app.studio().viewport().range_shown());
  app.press_item("side/scroll", {"Add"});
  CHECK(selected() == in_range);
  app.studio().apply(EditSelection{SelectionEdit::kNone});
  app.press_item("side/scroll", {"Colour"});
  choice.colour = base_colour(cloud, 0);
  app.frames(2);
  const UiRect add_colour = app.button("Add");
  app.move(0.5f * (add_colour.min + add_colour.max));
  REQUIRE(app.settle());
  const Flags of_colour = app.studio().viewport().style(0).highlight;
  REQUIRE(of_colour);
  app.press_item("side/scroll", {"Add"});
  CHECK(selected() == count_flags(*of_colour));
}

TEST_CASE("needles: how many times longer than wide, whatever the third axis") {
  GaussianCloud cloud = random_cloud(3, 1);
  cloud.scale = {{1, 8, 0.001f}, {2, 2, 1e-9f}, {5, 0, 0}};
  const std::vector<float> needles = property_values(cloud, Property::kNeedle);
  CHECK(needles[0] == doctest::Approx(8));
  CHECK(needles[1] == doctest::Approx(1));
  CHECK(needles[2] == doctest::Approx(1e4));
}

TEST_CASE("selection: footprint and centre mean the same in a region, behind it and in a volume") {
  // Seen along z from 10 units: 0.1 units to the pixel. The region and the volumes are the pixels 8 to 24 of
  // 33 and what projects there.
  const Camera camera = axis_camera();
  GaussianCloud cloud;
  cloud.resize(3, 0);
  const glm::vec3 centres[] = {{0, 0, 10}, {0.7f, 0, 10}, {1.0f, 0, 10}};
  const float sigmas[] = {0.1f, 1, 1};  // inside; its centre alone; its flank alone
  for (std::size_t g = 0; g < 3; ++g) {
    cloud.position[g] = centres[g];
    cloud.scale[g] = glm::vec3(sigmas[g]);
    cloud.opacity[g] = 0.5f;
  }
  const Mask region = rectangle_region({8, 8}, {25, 25}, 33, 33);
  const Volume box{false, {0, 0, 10}, glm::vec3(0.85f)}, ball{true, {0, 0, 10}, glm::vec3(0.85f)};
  for (const TakenBy by : {TakenBy::kFootprint, TakenBy::kCentre}) {
    CAPTURE(static_cast<int>(by));
    const Selection expected{1, by == TakenBy::kCentre, 0};
    CHECK(select_visible(cloud, camera, region, {}, by) == expected);
    CHECK(select_through(cloud, camera, region, {}, {.by = by}) == expected);
    CHECK(select_volume(cloud, box, {}, by) == expected);
    CHECK(select_volume(cloud, ball, {}, by) == expected);
  }
}

TEST_CASE("selection: a shape drawn around what one sees of a speck takes it, and no large blur around it") {
  const Camera camera = axis_camera();  // 0.1 units to the pixel, 10 units away
  GaussianCloud cloud;
  cloud.resize(3, 0);
  const glm::vec3 centres[] = {{0, 0, 10}, {0, 0, 10.1f}, {1.1f, 0, 10.1f}};
  const float sigmas[] = {0.5f, 3, 3};  // the speck; blurs whose centres lie inside and outside
  for (std::size_t g = 0; g < 3; ++g) {
    cloud.position[g] = centres[g];
    cloud.scale[g] = glm::vec3(sigmas[g]);
    cloud.opacity[g] = g == 0 ? 0.9f : 0.3f;
  }
  // A ring around the core of the speck, which is half as bright as its middle at 1.18 standard deviations.
  std::vector<glm::vec2> ring;
  for (int i = 0; i < 40; ++i) {
    const float angle = 2 * glm::pi<float>() * static_cast<float>(i) / 40;
    ring.push_back(glm::vec2(16.5f) + 6.2f * glm::vec2(std::cos(angle), std::sin(angle)));
  }
  const Mask region = polygon_region(ring, 33, 33);
  const Volume ball{true, {0, 0, 10}, glm::vec3(0.62f)};
  for (const TakenBy by : {TakenBy::kFootprint, TakenBy::kCentre}) {
    CAPTURE(static_cast<int>(by));
    const Selection expected{1, by == TakenBy::kCentre, 0};
    CHECK(select_visible(cloud, camera, region, {}, by) == expected);
    CHECK(select_through(cloud, camera, region, {}, {.by = by}) == expected);
    CHECK(select_volume(cloud, ball, {}, by) == expected);
  }
}

TEST_CASE("selection: a brush stays on the surface under its path") {
  // A slanted wall before a far one that nothing joins, and a hole in the picture.
  Image<float> depth(40, 20), half(20, 10);
  const auto depth_at = [](int x) { return x < 20 ? 2 + 0.02f * static_cast<float>(x) : x < 30 ? 4.0f : 0; };
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) depth.at(x, y) = half.at(x / 2, y / 2) = depth_at(x / 2 * 2);
  const auto columns = [&](std::vector<glm::vec2> path, const Image<float>& of) {
    const Mask reached = surface_region(brush_region(path, 6, 40, 20), path, of);
    std::pair<int, int> out{40, -1};
    for (int x = 0; x < 40; ++x)
      if (reached.at(x, 10)) out = {std::min(out.first, x), x};
    return out;
  };
  for (const Image<float>* of : {&depth, &half}) {
    CHECK(columns({{16.5f, 10.5f}}, *of) == std::pair(10, 19));  // stops at the jump
    CHECK(columns({{22.5f, 10.5f}}, *of) == std::pair(20, 28));
    CHECK(columns({{28.5f, 10.5f}}, *of) == std::pair(22, 29));                  // stops where nothing is
    CHECK(columns({{34.5f, 10.5f}}, *of) == std::pair(30, 39));                  // nothing is a surface, too
    CHECK(columns({{16.5f, 10.5f}, {24.5f, 10.5f}}, *of) == std::pair(10, 29));  // the path leads over it
  }
}

TEST_CASE("hands: a brush over the apple's edge takes the apple, and nothing of what is behind it") {
  Hands hands = hands_on_sample(false);
  const auto apple = sample_truth(*hands.studio().scene()->scene, kApple);
  hands.app.key('5');
  ViewState view = hands.studio().view();
  view.brush_px = 30;
  hands.studio().apply(SetView{view});
  const glm::vec2 at = hands.app.screen_of(kOnApple) - glm::vec2(0, 30), to = at + glm::vec2(3, 0);
  // Of what is taken. Leaves the object as it was.
  const auto share_of_others = [&] {
    const std::size_t all = hands.selected();
    REQUIRE(all > 100);
    const auto labels = hands.studio().labels(hands.studio().document().active);
    std::size_t others = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) others += labels[g] && !apple[g];
    hands.app.key('Z', {.ctrl = true});
    REQUIRE(hands.app.settle());
    return static_cast<double>(others) / static_cast<double>(all);
  };
  hands.app.drag({at, to});
  CHECK(share_of_others() < 0.01);
  const Camera camera = hands.studio().viewport().pane_camera();
  const std::vector<glm::vec2> path{hands.in_viewport(at), hands.in_viewport(to)};
  hands.studio().apply(
      SelectRegion{camera, brush_region(path, view.brush_px, camera.width_px, camera.height_px)});
  CHECK(share_of_others() > 0.05);  // any other region takes all that shows in it
  hands.app.key('V');
  hands.app.drag({at, to});
  CHECK(share_of_others() > 0.3);
}
