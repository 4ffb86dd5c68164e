// Selections, marks and looks as hands expect them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "app/document/document_edits.h"
#include "hands.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("tools: each has a name, a key, an action, words, and a symbol within its square") {
  std::set<std::string> names;
  std::set<std::pair<int, bool>> keys;
  for (const Binding& b : key_bindings())
    if (!b.modifiers.ctrl) CHECK_MESSAGE(keys.insert({b.key, b.modifiers.shift}).second, b.what);
  for (const Tool* tool : tools()) {
    const std::string name = tool->name;
    CAPTURE(name);
    CHECK(names.insert(name).second);
    CHECK(std::string(tool->sentence).ends_with('.'));
    REQUIRE(tool_of(action_of(*tool)));
    CHECK(*tool_of(action_of(*tool)) == *tool);
    CHECK(action_for(tool->key, {}) == action_of(*tool));
    REQUIRE((tool->icon != nullptr));
    for (const IconMark& mark : tool->icon())
      for (const glm::vec2& p : mark.points)
        CHECK(std::max(std::abs(p.x), std::abs(p.y)) + mark.radius <= 1.05f);
    // A tool that takes the drag does something with it, and shows it.
    if (tool->drag != Tool::Drag::kNavigates)
      CHECK((tool->release != nullptr && tool->shape != ToolShape::kNone));
  }
  CHECK_FALSE(tool_of(Action::kUndo));
}

TEST_CASE("hands: up by three points draws marks, and computes no object again") {
  Hands hands;
  const std::vector<std::uint8_t> before = hands.studio().labels(hands.studio().document().active);
  hands.app.key('0');
  const glm::vec2 low = hands.app->interface().viewport().min;
  const glm::vec2 ground[] = {low + glm::vec2(200, 330), low + glm::vec2(400, 330),
                              low + glm::vec2(300, 260)};
  for (std::size_t i = 0; i < 2; ++i) {
    hands.app.click(ground[i]);
    CHECK(hands.studio().overlay().points_px.size() == i + 1);
  }
  CHECK(hands.studio().overlay().shape == ToolOverlay::Shape::kPoints);
  CHECK(glm::distance(hands.studio().overlay().points_px.front(), hands.in_viewport(ground[0])) < 1.5f);
  const glm::vec3 up = hands.studio().document().up_world;
  hands.app.click(ground[2]);
  CHECK(hands.studio().document().up_world != up);
  CHECK_FALSE(hands.studio().cutting());
  hands.app.frames(2);
  CHECK_FALSE(hands.studio().cutting());
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().labels(hands.studio().document().active) == before);
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

TEST_CASE("hands: Shift adds, Ctrl removes, Alt intersects, with clicks as with regions") {
  Hands hands = hands_on_sample();
  const std::vector<std::uint8_t> apple = hands.studio().labels(hands.studio().document().active);
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kLeft, {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() > count_flags(apple));
  hands.app.click(hands.app.screen_of(kOnApple), PointerButton::kLeft, {.alt = true});
  REQUIRE(hands.app.settle());
  CHECK(iou_of(hands.studio().labels(hands.studio().document().active), apple) > 0.85);
  hands.app.click(hands.app.screen_of(kOnApple), PointerButton::kLeft, {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() < count_flags(apple) / 2);
  // Held keys show before anything is pressed.
  hands.app.key('6');
  hands.app->handle(KeyChanged{key::kLeftControl, true, false, {}});
  CHECK(hands.studio().overlay().operation == SetOperation::kRemove);
  hands.app->handle(KeyChanged{key::kLeftControl, false, false, {.ctrl = true}});
  CHECK(hands.studio().overlay().operation == SetOperation::kAdd);
}

TEST_CASE("hands: backgrounds go round, and the checker is behind the object alone") {
  Hands hands;
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const auto corner = [&](int x, int y) {
    return hands.studio().viewport().picture()->pictures.front().at(x, y);
  };
  std::vector<Rgba8> seen;
  for (std::size_t i = 0; i < backdrops().size(); ++i) {
    hands.app.key('J');
    REQUIRE(hands.app.settle());
    CHECK(hands.said() == std::string("Background: ") + backdrops()[(i + 1) % backdrops().size()].name);
    seen.push_back(corner(3, 3));
    if (hands.studio().view().checker)
      CHECK(corner(3, 3) != corner(3 + 12, 3));
    else
      CHECK(corner(3, 3) == corner(3 + 12, 3));
  }
  CHECK(seen[1] == Rgba8{255, 255, 255, 255});
  CHECK(seen[3] == Rgba8{255, 0, 255, 255});
  CHECK(shows(backdrops()[0], hands.studio().document(), hands.studio().view()));
}

TEST_CASE("hands: two points are measured in scene units") {
  Hands hands(false);
  hands.app.key('K');
  const glm::vec2 a = hands.app.screen_of(kOnApple), b = hands.app.screen_of(kOnMug);
  const float truth = glm::distance(hands.under(a), hands.under(b));
  hands.app.click(a);
  CHECK_FALSE(hands.studio().overlay().length);
  hands.app.click(b);
  REQUIRE(hands.studio().overlay().length);
  CHECK(*hands.studio().overlay().length == doctest::Approx(truth).epsilon(1e-4));
  CHECK(hands.studio().document().objects.empty());
}

TEST_CASE("hands: a sphere and a box in space select by a drag, and again by their handles") {
  Hands hands = hands_on_sample(false);
  const Scene& scene = *hands.studio().scene()->scene;
  const auto apple = sample_truth(scene, kApple);
  const auto share = [&] {
    REQUIRE(hands.app.settle());
    const auto labels = hands.studio().labels(hands.studio().document().active);
    std::size_t both = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) both += labels[g] && apple[g];
    return static_cast<double>(both) / static_cast<double>(count_flags(apple));
  };
  for (const char tool : {'9', 'Y'}) {
    CAPTURE(tool);
    hands.app.key(tool);
    const std::size_t steps = hands.steps();
    const glm::vec2 at = hands.app.screen_of(kOnApple);
    hands.app.drag({at, at + glm::vec2(20, 0), at + glm::vec2(30, 0)});
    const std::size_t first = hands.selected();
    const double part = share();
    CHECK(first > 100);
    CHECK(hands.steps() == steps + 1);
    const auto handles = hands.studio().overlay().handles_px;
    REQUIRE(handles.size() == (tool == '9' ? 2 : 7));
    const glm::vec2 low = hands.app->interface().viewport().min;
    const glm::vec2 middle = low + handles[0], rim = low + handles[1];
    const glm::vec2 outwards = glm::normalize(rim - middle) * 30.0f;
    hands.app.drag({rim, rim + 0.5f * outwards, rim + outwards});
    CHECK(hands.selected() > first);
    CHECK(share() >= part);
    CHECK(hands.steps() == steps + 1);  // one step, as it was changed
    const std::size_t larger = hands.selected();
    const glm::vec2 now = low + hands.studio().overlay().handles_px[0];  // a box keeps its other face
    hands.app.drag({now, now + glm::vec2(200, -150), now + glm::vec2(400, -300)});
    CHECK(hands.selected() != larger);
    CHECK(hands.steps() == steps + 1);
    hands.app.key(key::kEscape);
    CHECK(hands.studio().overlay().handles_px.empty());
    hands.app.key('Z', {.ctrl = true});
    CHECK(hands.selected() == 0);
  }
}

TEST_CASE("hands: a volume that took nothing yet is changed without a step before it being lost") {
  Hands hands(false);
  hands.studio().apply(NewObject{});
  const std::size_t steps = hands.steps();
  const Volume nowhere{true, glm::vec3(1e4f), glm::vec3(1)};
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd});
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd, true});
  CHECK(hands.steps() == steps);
  CHECK(hands.studio().document().objects.size() == 1);
  // Nor one after it.
  hands.studio().apply(NewObject{});
  hands.studio().apply(Undo{});
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd});
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd, true});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().history().can_redo());
}

TEST_CASE("hands: a volume replaces what it took, though a cut is done in between") {
  Hands hands;
  const Volume on_mug{true, hands.under(hands.app.screen_of(kOnMug)), glm::vec3(0.1f)};
  const Volume nowhere{true, glm::vec3(1e4f), glm::vec3(1)};
  hands.studio().apply(
      AddStroke{hands.studio().viewport().pane_camera(),
                click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
  hands.studio().update(1.0 / 60);
  REQUIRE(hands.studio().cutting());
  hands.studio().apply(SelectVolume{on_mug, SetOperation::kAdd});
  REQUIRE(hands.app.settle());
  const std::size_t steps = hands.steps();
  const ObjectItem& object = *hands.studio().document().active_object();
  REQUIRE(object.cut);
  REQUIRE(hands.selected() > count_flags(*object.cut));
  hands.studio().apply(SelectVolume{nowhere, SetOperation::kAdd, true});
  CHECK(hands.steps() == steps);
  const ObjectItem& now = *hands.studio().document().active_object();
  CHECK(hands.studio().labels(now.id) == *now.cut);
}

TEST_CASE(
    "hands: a volume changed while its object is shown alone takes what was to be seen, and ends nothing") {
  Hands hands = hands_on_sample(false);
  const Volume small{true, hands.under(hands.app.screen_of(kOnApple)), glm::vec3(0.02f)};
  Volume large = small;
  large.half = glm::vec3(0.1f);
  hands.studio().apply(SelectVolume{small, SetOperation::kAdd});
  REQUIRE(hands.app.settle());
  const std::size_t first = hands.selected();
  REQUIRE(first > 0);
  hands.studio().run(Action::kIsolate);
  REQUIRE(hands.app.settle());
  hands.studio().apply(SelectVolume{large, SetOperation::kAdd, true});
  CHECK(hands.selected() > first);
  CHECK(hands.studio().view().display == DisplayMode::kIsolate);
}

TEST_CASE("hands: a press without a drag leaves the sphere that is there") {
  Hands hands(false);
  hands.app.key('9');
  const glm::vec2 at = hands.app.screen_of(kOnApple), beside = hands.app.screen_of(kOnOrange);
  hands.app.drag({at, at + glm::vec2(20, 0), at + glm::vec2(30, 0)});
  const auto handles = hands.studio().overlay().handles_px;
  REQUIRE(handles.size() == 2);
  const std::size_t steps = hands.steps();
  hands.app.click(beside);
  CHECK(hands.studio().overlay().handles_px == handles);
  CHECK(hands.steps() == steps);
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

TEST_CASE("hands: a drag goes on in the pane where it was pressed") {
  Hands hands;
  hands.app.key('B');
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().viewport().panes() == 2);
  const UiRect view = hands.app->interface().viewport();
  const glm::vec2 left = view.min + glm::vec2(120, 150), half(0.5f * view.size().x, 0);
  const CameraPose before = hands.studio().camera().pose();
  const auto turned = [&](const glm::vec2& from) {
    hands.studio().camera().set_pose(before);
    hands.app.drag({from, from + glm::vec2(10, 4), from + glm::vec2(20, 8)}, PointerButton::kMiddle);
    return hands.studio().camera().pose().camera_from_world;  // each pane may turn about what it shows
  };
  CHECK(turned(left) == turned(left + half));
  hands.app.key('6');
  hands.app.move(left + half);
  hands.app.press(PointerButton::kLeft);
  hands.app.move(left + half + glm::vec2(12, 0));
  for (const glm::vec2& p : hands.studio().overlay().points_px)
    CHECK(glm::distance(p, glm::vec2(120, 150)) < 15);
  hands.app.release(PointerButton::kLeft);
}

TEST_CASE("hands: a box around a second thing leaves what was clicked first") {
  Hands hands = hands_on_sample();
  const Scene& scene = *hands.studio().scene()->scene;
  const auto share_of = [&](std::uint8_t thing) {
    const auto labels = hands.studio().labels(hands.studio().document().active),
               truth = sample_truth(scene, thing);
    std::size_t both = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) both += labels[g] && truth[g];
    return static_cast<double>(both) / static_cast<double>(count_flags(truth));
  };
  REQUIRE(share_of(kApple) > 0.8);
  hands.app.key('4');
  const glm::vec2 at = hands.app.screen_of(kOnOrange);
  hands.app.drag({at - 34.0f, at, at + 34.0f});
  REQUIRE(hands.app.settle());
  CHECK(share_of(kApple) > 0.8);
  CHECK(share_of(kOrange) > 0.5);
}

TEST_CASE("hands: keys held with a box add what it would cut out, remove it, or keep it alone") {
  Hands hands = hands_on_sample();
  const Scene& scene = *hands.studio().scene()->scene;
  const auto share_of = [&](std::uint8_t thing) {
    const std::vector<std::uint8_t> labels = hands.studio().labels(hands.studio().document().active),
                                    truth = sample_truth(scene, thing);
    std::size_t both = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) both += labels[g] && truth[g];
    return static_cast<double>(both) / static_cast<double>(count_flags(truth));
  };
  const auto box_around = [&](const glm::vec2& pixel, const Modifiers& held) {
    const glm::vec2 at = hands.app.screen_of(pixel);
    hands.app.move(at - 34.0f, held);
    hands.app.press(PointerButton::kLeft, held);
    hands.app.move(at + 34.0f, held);
    hands.app.release(PointerButton::kLeft, held);
    hands.app->frame(0.5);  // no double-click with the next
    REQUIRE(hands.app.settle());
  };
  REQUIRE(share_of(kApple) > 0.8);
  REQUIRE(share_of(kOrange) < 0.1);
  hands.app.key('4');
  box_around(kOnOrange, {.shift = true});
  CHECK(share_of(kApple) > 0.8);
  CHECK(share_of(kOrange) > 0.5);
  const std::vector<std::uint8_t> both = hands.studio().labels(hands.studio().document().active);
  box_around(kOnOrange, {.ctrl = true});
  CHECK(share_of(kApple) > 0.8);
  CHECK(share_of(kOrange) < 0.1);  // what the box takes alone, not what was added
  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().labels(hands.studio().document().active) == both);
  box_around(kOnOrange, {.alt = true});
  CHECK(share_of(kApple) < 0.05);
  CHECK(share_of(kOrange) > 0.5);
  const std::size_t entries = hands.studio().history().entries().size();
  hands.studio().apply(
      AddBox{hands.studio().viewport().pane_camera(), {5, 5}, {7, 7}, {}, SetOperation::kRemove});
  CHECK(hands.said().starts_with("The box is too small"));
  CHECK(std::string_view(Tool::kBox.hint).find("Shift: add") != std::string_view::npos);
  CHECK(hands.studio().history().entries().size() == entries);
}

TEST_CASE("hands: a box with Ctrl or Alt wants an object to work on") {
  Hands hands(false);
  const Camera camera = hands.studio().viewport().pane_camera();
  for (const SetOperation operation : {SetOperation::kRemove, SetOperation::kIntersect}) {
    hands.studio().apply(AddBox{camera, {100, 100}, {300, 300}, {}, operation});
    CHECK(hands.said().find("There is no object yet") != std::string::npos);
  }
  CHECK(hands.studio().document().objects.empty());
}

TEST_CASE("hands: a box that reaches out of the picture is around what of it is inside") {
  Hands hands(false);
  const Camera camera = hands.studio().viewport().pane_camera();
  const auto width = static_cast<float>(camera.width_px);
  hands.studio().apply(AddBox{camera, {width - 3, 60}, {width + 300, 200}});
  CHECK(hands.said().starts_with("The box is too small"));
  CHECK(hands.studio().document().objects.empty());
  hands.studio().apply(AddBox{camera, {width - 40, 60}, {width + 300, 200}});
  const ObjectItem* object = hands.studio().document().active_object();
  REQUIRE(object);
  REQUIRE(object->views.front().strokes.size() == 1);
  const Stroke& box = object->views.front().strokes.front();
  CHECK(box.is_box());
  CHECK(box.label == SeedLabel::kObject);
  CHECK(box_in_picture(box, camera.width_px, camera.height_px).low_px == glm::vec2(width - 40, 60));
  CHECK(box_in_picture(box, camera.width_px, camera.height_px).high_px == glm::vec2(width, 200));
}

TEST_CASE("hands: a box around a thing takes nothing that stands outside of it") {
  Hands hands = hands_on_sample(false);
  const Scene& scene = *hands.studio().scene()->scene;
  for (const auto& [thing, name] : {std::pair{kApple, "apple"}, {kOrange, "orange"}, {kMug, "mug"}}) {
    CAPTURE(name);
    const auto truth = sample_truth(scene, thing);
    glm::vec2 low(1e9f), high(-1e9f);
    for (std::size_t g = 0; g < truth.size(); ++g) {
      if (!truth[g]) continue;
      const glm::vec2 at = hands.seen_at(scene.cloud.position[g]);
      low = glm::min(low, at), high = glm::max(high, at);
    }
    hands.studio().apply(NewObject{});
    hands.app.key('4');
    const glm::vec2 a = low - 4.0f, b = high + 4.0f;
    hands.app.drag({a, 0.5f * (a + b), b});
    REQUIRE(hands.app.settle());
    const auto labels = hands.studio().labels(hands.studio().document().active);
    std::size_t outside = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) {
      const glm::vec2 at = hands.seen_at(scene.cloud.position[g]);
      outside += labels[g] && (at.x < a.x || at.y < a.y || at.x > b.x || at.y > b.y);
    }
    MESSAGE(std::string(name), ": IoU ", iou_of(labels, truth), ", outside ", outside, " of ",
            count_flags(labels));
    CHECK(static_cast<double>(outside) < 0.01 * static_cast<double>(count_flags(labels)));
    CHECK(iou_of(labels, truth) > 0.8);
  }
}

TEST_CASE("hands: a box around a pot leaves the plant that grows out of it, but for what hangs over") {
  Hands hands = hands_on_sample(false);
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  hands.app.key('4');
  const glm::vec2 a = hands.app.screen_of({560, 268}), b = hands.app.screen_of({728, 404});
  hands.app.drag({a, 0.5f * (a + b), b});
  REQUIRE(hands.app.settle());
  const auto labels = hands.studio().labels(hands.studio().document().active);
  std::size_t outside = 0;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    const glm::vec2 at = hands.seen_at(cloud.position[g]);
    outside += labels[g] && (at.x < a.x || at.y < a.y || at.x > b.x || at.y > b.y);
  }
  MESSAGE("outside ", outside, " of ", count_flags(labels));
  CHECK(static_cast<double>(outside) < 0.25 * static_cast<double>(count_flags(labels)));
}

TEST_CASE("hands: side by side, what is drawn in the right pane takes what that pane shows") {
  Hands hands;
  Studio& studio = hands.studio();
  const std::size_t apple = hands.selected();
  ViewState view = studio.view();
  view.display = DisplayMode::kSideBySide;
  view.tool = Tool::kRectangle;
  studio.apply(SetView{view});
  REQUIRE(hands.app.settle());
  const UiRect area = hands.app->interface().viewport();
  const glm::vec2 size = area.size();
  const auto drag = [&](float from, float to) {
    hands.app.drag({area.min + size * glm::vec2(from, 0.1f), area.min + size * glm::vec2(to, 0.8f)});
    return hands.selected();
  };
  CHECK(drag(0.55f, 0.95f) == apple);  // the object stands there alone
  CHECK(drag(0.05f, 0.45f) > 2 * apple);
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

TEST_CASE(
    "hands: while meanings of a box are offered 2 takes one, and is the tool Click after a tool's button") {
  Hands hands = hands_on_sample(false);
  Studio& studio = hands.studio();
  const auto box = [&] {
    hands.app.key('4');
    const glm::vec2 at = hands.app.screen_of(kOnApple);
    hands.app.drag({at - 60.0f, at, at + 60.0f});
    REQUIRE(hands.app.settle());
    REQUIRE(studio.clicks().offer());
  };
  box();
  CHECK(studio.clicks().chooses_by('2'));
  hands.app.key('2');
  REQUIRE(hands.app.settle());
  CHECK(studio.document().active_object()->choice == 1);
  CHECK(tool_of(studio.view().tool).name == std::string(tool_of(Tool::kBox).name));
  studio.run(Action::kToolNavigate);  // its button
  CHECK_FALSE(studio.clicks().chooses_by('2'));
  hands.app.key('2');
  CHECK(tool_of(studio.view().tool).name == std::string(tool_of(Tool::kClick).name));
  CHECK(studio.document().active_object()->choice == 1);
  CHECK_FALSE(studio.clicks().offer());
}

TEST_CASE("hands: boxes that remove, one right after the other, all remove") {
  Hands hands = hands_on_sample(false);
  Studio& studio = hands.studio();
  studio.apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(hands.app.settle());
  const std::size_t steps = studio.history().entries().size();
  const Camera camera = studio.viewport().pane_camera();
  for (const glm::vec2& thing : {kOnApple, kOnOrange, kOnMug}) {
    const glm::vec2 at = hands.in_viewport(hands.app.screen_of(thing));
    studio.apply(AddBox{camera, at - 34.0f, at + 34.0f, {}, SetOperation::kRemove});
  }
  REQUIRE(hands.app.settle());
  CHECK(studio.history().entries().size() == steps + 3);
}

TEST_CASE("hands: alone, an object that stays empty is no black picture") {
  Hands hands;
  Studio& studio = hands.studio();
  studio.run(Action::kIsolate);
  REQUIRE(hands.app.settle());
  REQUIRE(studio.view().display == DisplayMode::kIsolate);
  studio.apply(Recompute{});
  hands.app.frames(1);
  studio.apply(NewObject{});
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK(studio.view().display == DisplayMode::kWhole);
}

TEST_CASE("hands: another method does not change what is locked") {
  Hands hands = hands_on_sample();
  Studio& studio = hands.studio();
  const ObjectId object = studio.document().active;
  const auto before = studio.labels(object);
  studio.apply(LockObject{object, true});
  studio.apply(SetPreset{"paper-code"});
  REQUIRE(hands.app.settle());
  CHECK(studio.labels(object) == before);
  studio.apply(LockObject{object, false});
  REQUIRE(hands.app.settle());
  CHECK(studio.labels(object) != before);
}
