// Tools as hands expect them: each is complete, up by three points, measures, keys that are held.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "hands.h"

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

TEST_CASE("hands: up by three points is the ground's, also where a point is on a Gaussian alone in the air") {
  const ScratchFolder folder("ground");
  Scene scene;
  GaussianCloud& cloud = scene.cloud;
  constexpr std::size_t kSide = 90;
  cloud.resize(kSide * kSide + 1, 0);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const auto across = static_cast<float>(g % kSide), along = static_cast<float>(g / kSide);
    cloud.position[g] = {across / 22 - 2, 0.5f, along / 22 - 2};
    cloud.scale[g] = {0.04f, 0.002f, 0.04f};
    cloud.opacity[g] = 0.95f;
    cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  const glm::vec3 alone(0.2f, -0.35f, 0);
  cloud.position.back() = alone;
  cloud.scale.back() = glm::vec3(0.01f);
  scene.file_rows = cloud.size();
  save_scene(folder / "ground.ply", scene, {}, SceneFormat::kPly);
  Hands hands(false, with_kept_scenes(), folder / "ground.ply");
  hands.studio().apply(SetUp{{0, -1, 0}});
  hands.studio().apply(GoToCamera{look_at({0, -1.4f, -2}, {0, 0.5f, 0}, {0, -1, 0}, 0.9f, 640, 480)});
  REQUIRE(hands.app.settle());
  REQUIRE(hands.under(hands.seen_at(alone)).y < 0);
  hands.app.key('0');
  for (const glm::vec3& at : {glm::vec3(-0.7f, 0.5f, -0.4f), {-0.5f, 0.5f, 0.6f}, alone})
    hands.app.click(hands.seen_at(at));
  REQUIRE(hands.app.settle());
  const glm::vec3 up = hands.studio().document().up_world;
  CAPTURE(up.x);
  CAPTURE(up.z);
  CHECK(hands.said() == "Up direction set");
  CHECK(glm::dot(up, glm::vec3(0, -1, 0)) > 0.999f);
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

TEST_CASE("tools: the steps of brush, lasso and rectangle say which of them was used, those of a box that") {
  Hands hands(false);
  const auto step = [&] {
    REQUIRE(hands.app.settle());
    return hands.studio().history().entries()[hands.studio().history().cursor()].title;
  };
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  const std::pair<Action, const char*> tools[] = {{action_of(Tool::kBrush), "Add (brush, visible)"},
                                                  {action_of(Tool::kLasso), "Add (lasso, visible)"},
                                                  {action_of(Tool::kRectangle), "Add (rectangle, visible)"}};
  for (const auto& [action, title] : tools) {
    hands.studio().run(Action::kNewObject);
    hands.studio().run(action);
    hands.app.drag({at - glm::vec2(20), at + glm::vec2(20, -20), at + glm::vec2(20)});
    CHECK(step() == title);
  }
  const Camera camera = hands.studio().viewport().pane_camera();
  const glm::vec2 middle = hands.in_viewport(at);
  hands.studio().apply(NewObject{});
  hands.studio().apply(AddBox{camera, middle - 30.0f, middle + 30.0f});
  REQUIRE(hands.app.settle());
  hands.studio().apply(ChooseMeaning{1});
  CHECK(step() == "Meaning 2 of the box");
  hands.studio().apply(NewObject{});
  hands.app.studio().run(action_of(Tool::kClick));
  hands.app.click(at);
  REQUIRE(hands.app.settle());
  hands.studio().apply(ChooseMeaning{1});
  CHECK(step() == "Meaning 2 of the click");
}
