// Boxes around things in the picture: what they cut out, with keys held, and their meanings.
#include <doctest/doctest.h>

#include <string>
#include <string_view>

#include "hands.h"
#include "scene/formats/scene_file.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void box_apple(Hands* hands) {
  hands->app.key('4');
  const glm::vec2 at = hands->app.screen_of(kOnApple);
  hands->app.drag({at - 60.0f, at, at + 60.0f});
}

}  // namespace

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

TEST_CASE("hands: a click with the box in hand is a click, of either button") {
  Hands hands = hands_on_sample();
  const auto labels = [&] { return hands.studio().labels(hands.studio().document().active); };
  const auto clicked = [&](PointerButton button) {
    hands.app.click(hands.app.screen_of(kOnOrange), button);
    hands.app->frame(0.5);  // no double-click with the next
    REQUIRE(hands.app.settle());
    hands.app.move(hands.app->interface().viewport().min + glm::vec2(300, 60));
    return labels();
  };
  const auto apple = labels();
  const auto both = clicked(PointerButton::kLeft), without = clicked(PointerButton::kRight);
  for (int undone = 0; undone < 2; ++undone) hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  REQUIRE(labels() == apple);
  hands.app.key('4');
  CHECK(clicked(PointerButton::kLeft) == both);
  CHECK(clicked(PointerButton::kRight) == without);
  CHECK(count_flags(both) > count_flags(without));
}

TEST_CASE("hands: a box with the right button removes as one with Ctrl does, and the view stays") {
  Hands hands = hands_on_sample();
  const auto labels = [&] { return hands.studio().labels(hands.studio().document().active); };
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto both = labels();
  hands.app.key('4');
  const glm::vec2 at = hands.app.screen_of(kOnOrange);
  const CameraPose pose = hands.studio().viewport().camera().pose();
  hands.app.drag({at - 34.0f, at, at + 34.0f}, PointerButton::kRight);
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport().camera().pose() == pose);
  const auto by_button = labels();
  CHECK(count_flags(by_button) < count_flags(both));
  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  REQUIRE(labels() == both);
  hands.app.move(at - 34.0f, {.ctrl = true});
  hands.app.press(PointerButton::kLeft, {.ctrl = true});
  hands.app.move(at + 34.0f, {.ctrl = true});
  hands.app.release(PointerButton::kLeft, {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(labels() == by_button);
}

TEST_CASE("hands: a box that could only add is refused where the object is shown alone, the others work") {
  Hands hands = hands_on_sample();
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  hands.studio().run(Action::kIsolate);
  hands.app.key('4');
  const std::size_t steps = hands.steps(), both = hands.selected();
  const glm::vec2 at = hands.app.screen_of(kOnOrange);
  hands.app.drag({at - 34.0f, at, at + 34.0f});
  CHECK(hands.steps() == steps);
  CHECK(hands.said() ==
        "All that is shown belongs to Object 1 already. The right button, or Ctrl, removes what a box holds; "
        "Alt keeps it alone.");
  CHECK(hands.selected() == both);
  hands.app.drag({at - 34.0f, at, at + 34.0f}, PointerButton::kRight);
  CHECK(hands.steps() == steps + 1);
  CHECK(hands.selected() < both);
  CHECK(hands.studio().view().display == DisplayMode::kIsolate);
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
  CHECK(hands.said().starts_with("The box is too narrow"));
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

TEST_CASE(
    "hands: right after a box, 2 and 3 are no tools: what else it can mean is chosen once it is computed") {
  Hands hands = hands_on_sample(false);
  Studio& studio = hands.studio();
  box_apple(&hands);
  REQUIRE(studio.cutting());
  for (const int key : {'2', '3'}) {
    hands.app.key(key);
    CHECK(studio.view().tool == ToolId(Tool::kBox));
    CHECK(hands.said().find("as soon as Object 1 is computed") != std::string::npos);
  }
  REQUIRE(hands.app.settle());
  REQUIRE(studio.clicks().offer());
  hands.app.key('2');
  REQUIRE(hands.app.settle());
  CHECK(studio.document().active_object()->choice == 1);

  hands.app.key('N', {.ctrl = true});
  box_apple(&hands);
  REQUIRE(studio.cutting());
  hands.app.key(key::kEscape);  // nothing comes any more
  REQUIRE(hands.app.settle());
  hands.app.key('3');
  CHECK(studio.view().tool == ToolId(Tool::kScribble));
}

TEST_CASE("hands: another tool ends an offer that is hidden, too: 2 is a tool then and takes nothing") {
  Hands hands = hands_on_sample(false);
  Studio& studio = hands.studio();
  box_apple(&hands);
  REQUIRE(hands.app.settle());
  REQUIRE(studio.clicks().offer());
  hands.app.key('I');  // where no meaning is offered
  hands.app.key('1');
  REQUIRE(studio.view().tool == ToolId(Tool::kNavigate));
  hands.app.key('I');
  for (int i = 0; i < 2; ++i) hands.app.key('2');
  REQUIRE(hands.app.settle());
  CHECK(studio.view().tool == ToolId(Tool::kClick));
  CHECK(!studio.clicks().offer());
  CHECK(studio.document().active_object()->choice == 0);
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

TEST_CASE("hands: what is asked for after a box that removes comes after it, and Esc takes the box back") {
  const ScratchFolder folder("box_removes");
  Hands hands = hands_on_sample(false);
  Studio& studio = hands.studio();
  studio.apply(EditSelection{SelectionEdit::kAll});
  const std::size_t all = hands.selected(), before = studio.history().cursor();
  const glm::vec2 at = hands.in_viewport(hands.app.screen_of(kOnOrange));
  const AddBox removes{studio.viewport().pane_camera(), at - 34.0f, at + 34.0f, {}, SetOperation::kRemove};
  studio.apply(removes);
  studio.apply(Undo{});
  CHECK(hands.steps() == before);
  CHECK(studio.history().entries().size() == before + 2);
  CHECK(hands.selected() == all);
  studio.apply(Redo{});
  const std::size_t left = hands.selected();
  CHECK(left < all);
  studio.apply(Undo{});

  studio.apply(removes);
  studio.apply(Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "left.ply"}});
  studio.apply(NewObject{});
  REQUIRE(hands.app.settle());
  CHECK(load_scene(folder / "left.ply").cloud.size() == left);
  CHECK(studio.gaussians_of(studio.document().objects.front().id) == left);
  CHECK(studio.document().objects.size() == 2);
  studio.apply(JumpHistory{before});

  studio.apply(removes);
  CHECK(studio.unsaved());
  studio.apply(Cancel{});
  CHECK_FALSE(studio.waiting());
  CHECK(hands.steps() == before);
  CHECK(hands.selected() == all);
}
