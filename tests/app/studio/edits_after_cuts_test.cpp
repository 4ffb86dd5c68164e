// What is done to an object right after a click waits for the cut of that click.
#include <doctest/doctest.h>

#include "hands.h"
#include "scene/formats/scene_file.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// No time for the cut to end.
void click_apple(Hands& hands) {
  hands.app->advance(0.5);  // no double-click with the last
  hands.app.move(hands.app.screen_of(kOnApple));
  hands.app.press(PointerButton::kLeft);
  hands.app.release(PointerButton::kLeft);
  REQUIRE(hands.studio().cuts().next() != 0);
}

}  // namespace

TEST_CASE("edits after cuts: the same comes out in haste as after the cut") {
  Hands patient, hasty(false);
  const auto same_after = [&](const auto& does) {
    does(patient.studio());
    REQUIRE(patient.app.settle());
    does(hasty.studio());
    REQUIRE(hasty.app.settle());
    const Studio &a = patient.studio(), &b = hasty.studio();
    REQUIRE(a.document().objects.size() == b.document().objects.size());
    for (std::size_t i = 0; i < a.document().objects.size(); ++i)
      CHECK(a.labels(a.document().objects[i].id) == b.labels(b.document().objects[i].id));
    CHECK(a.history().entries().size() == b.history().entries().size());
  };
  const std::size_t all = patient.studio().scene()->cloud->size(), apple = patient.selected();
  click_apple(hasty);
  same_after([](Studio& s) { s.run(Action::kInvert); });
  CHECK(hasty.selected() == all - apple);
  same_after([](Studio& s) { s.run(Action::kUndo); });
  same_after([](Studio& s) { s.run(Action::kUndo); });  // the click
  CHECK(hasty.selected() == 0);
  patient.app.click(patient.app.screen_of(kOnApple));
  REQUIRE(patient.app.settle());
  click_apple(hasty);
  same_after([](Studio& s) { s.apply(DuplicateObject{s.document().active}); });
  CHECK(hasty.selected() == apple);
}

TEST_CASE("edits after cuts: an object is deleted, its export holds it, and Esc drops what waits") {
  const ScratchFolder folder("edits_after_cuts");
  Hands hands(false);
  Studio& studio = hands.studio();
  click_apple(hands);
  studio.run(Action::kDelete);
  CHECK(hands.said().find("as soon as") != std::string::npos);
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.document().deleted);
  CHECK(studio.document().objects.size() == 1);  // the stroke stays

  studio.run(Action::kUndo);
  REQUIRE(hands.app.settle());
  click_apple(hands);
  Export wanted;
  wanted.request.path = folder / "apple.ply";
  studio.apply(wanted);
  const std::size_t apple = hands.selected();
  REQUIRE(apple > 0);
  CHECK(load_scene(folder / "apple.ply").cloud.size() == apple);

  studio.run(Action::kUndo);
  REQUIRE(hands.app.settle());
  click_apple(hands);
  studio.run(Action::kDelete);
  REQUIRE(hands.app.settle());
  REQUIRE(studio.document().deleted);
  CHECK(count_flags(*studio.document().deleted) == apple);
}

TEST_CASE("edits after cuts: with an export that Esc drops, the scene that was to follow it is not opened") {
  const ScratchFolder folder("scene_after_export");
  Hands hands(false);
  Studio& studio = hands.studio();
  click_apple(hands);
  Export wanted;
  wanted.request.path = folder / "apple.ply";
  studio.apply(wanted);
  studio.apply(OpenScene{kSample});
  REQUIRE(hands.said() == "The scene is opened as soon as the file that waits is written");
  studio.apply(Cancel{});
  CHECK(hands.said().starts_with("Cancelled. "));
  CHECK(hands.said().find("Export: not done, and the other scene is not opened") != std::string::npos);
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->scene->path == kSmallSample);
  CHECK(studio.document().objects.size() == 1);
  CHECK_FALSE(std::filesystem::exists(folder / "apple.ply"));
  studio.apply(Recompute{});  // and a file that is written lets it follow
  studio.apply(wanted);
  studio.apply(OpenScene{kSample});
  REQUIRE(hands.app.settle());
  CHECK(std::filesystem::exists(folder / "apple.ply"));
  CHECK(studio.scene()->scene->path == kSample);
}

TEST_CASE("hands: keys that need the object wait for its first cut, the last of a kind") {
  Hands hands(false);
  Studio& studio = hands.studio();
  const auto click = [&](const glm::vec2& at) {
    studio.apply(AddStroke{studio.viewport().pane_camera(),
                           {SeedLabel::kObject, 4, {hands.in_viewport(hands.app.screen_of(at))}}});
  };
  const CameraPose pose = studio.camera().pose();
  click(kOnApple);
  studio.run(Action::kHide);
  studio.run(Action::kIsolate);
  studio.run(Action::kFrameObject);
  CHECK(studio.view().display == DisplayMode::kWhole);
  REQUIRE(hands.app.settle());
  CHECK(studio.view().display == DisplayMode::kIsolate);
  CHECK_FALSE(studio.camera().pose() == pose);

  studio.apply(SetView{});
  studio.apply(GoToCamera{studio.scene()->views().reference});
  studio.apply(NewObject{});
  REQUIRE(hands.app.settle());
  click(kOnMug);
  studio.run(Action::kFrameObject);
  studio.camera().orbit({20, 0});  // another view is wanted now
  const CameraPose turned = studio.camera().pose();
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() > 0);
  CHECK(studio.camera().pose() == turned);

  studio.apply(GoToCamera{studio.scene()->views().reference});
  studio.apply(NewObject{});
  REQUIRE(hands.app.settle());
  click(kOnOrange);
  studio.run(Action::kHide);
  click(kOnOrange + glm::vec2(6, 0));  // another click drops it
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() > 0);
  CHECK(studio.view().display == DisplayMode::kWhole);
  studio.apply(NewObject{});
  click(kOnMug);
  studio.run(Action::kHide);
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK(studio.view().display == DisplayMode::kWhole);
}
