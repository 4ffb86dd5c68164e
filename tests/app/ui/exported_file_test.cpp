// The file that was exported last: dragged out of the window, its path copied, not shown with another scene.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "app/window/file_drag.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE(
    "ui: one leaves without a question once all objects are exported as they are and the work is kept") {
  const ScratchFolder folder("leave_exported");
  std::filesystem::create_directories(folder / "state");
  ApplicationOptions options = with_kept_scenes();
  SUBCASE("kept by itself") {
    options.studio.state_folder = folder / "state";
  }
  SUBCASE("not kept") {}
  const bool kept = !options.studio.state_folder.empty();
  Hands hands(true, options);
  const auto asked = [&] {
    hands.studio().run(Action::kQuit);
    hands.app.frames(3);
    const bool open = hands.app->interface().dialog_open();
    if (open) hands.app.key(key::kEscape);
    hands.app.frames(3);
    return open;
  };
  const auto write = [&](ExportWhat what, const char* name) {
    hands.studio().apply(Export{{what, SceneFormat::kSplat, folder / name, true}});
    REQUIRE(hands.app.settle());
  };
  CHECK(asked());
  write(ExportWhat::kScene, "all.splat");
  CHECK(asked());  // the object is in no file
  write(ExportWhat::kObject, "apple.splat");
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  CHECK(asked());  // the mug is in none
  CHECK_FALSE(hands.app->wants_to_close());
  write(ExportWhat::kObject, "apple.splat");
  CHECK(asked());  // the apple is in none any more
  write(ExportWhat::kAllObjects, "both");
  CHECK(hands.studio().unsaved());
  CHECK(asked() == !kept);
  CHECK(hands.app->wants_to_close() == kept);
}

TEST_CASE("ui: what was exported last is dragged out of the window, or its path is copied by a click") {
  const ScratchFolder folder("drag_out");
  Hands hands(false);
  UiState& state = hands.app.interface_state();
  hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "all.splat"}});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  CHECK(hands.studio().exports().last() == folder / "all.splat");
  const UiRect button = hands.app.button("all.splat");
  REQUIRE(button.size().x > 0);
  const glm::vec2 row = 0.5f * (button.min + button.max);
  hands.app.move(row);
  hands.app.press(PointerButton::kLeft);
  hands.app.frames(2);
  CHECK_FALSE(state.dragged_out);
  hands.app.move(row + glm::vec2(12, 0));
  hands.app.frames(1);
  CHECK(state.dragged_out == folder / "all.splat");
  state.dragged_out.reset();  // the window takes it
  hands.app.move(row + glm::vec2(60, 5));
  hands.app.frames(2);
  CHECK_FALSE(state.dragged_out);  // once
  hands.app.move(row + glm::vec2(300, 300));
  hands.app.release(PointerButton::kLeft);
  hands.app.frames(2);
  hands.app.click(row);
  hands.app.frames(1);
  CHECK(std::string(ImGui::GetClipboardText()) == folder / "all.splat");
}

TEST_CASE("ui: what was exported of a scene is not shown with another one") {
  const ScratchFolder folder("exported_before");
  Hands hands(false);
  hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "all.splat"}});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  REQUIRE(hands.app.button("all.splat").size().x > 0);
  hands.studio().apply(OpenScene{kSample});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  REQUIRE(hands.studio().scene()->scene->path == kSample);
  CHECK(hands.app.button("all.splat").size().x == 0);
  CHECK(hands.studio().exports().last().empty());
}

TEST_CASE("ui: what is being written is named as what it is, in turn, and nothing is once all is written") {
  const ScratchFolder folder("named_exports");
  Hands hands;
  Studio& studio = hands.studio();
  Export scene{{ExportWhat::kScene, SceneFormat::kSplat, folder / "all.splat"}};
  studio.apply(scene);
  REQUIRE(hands.app.settle());
  CHECK(studio.exports().doing().empty());
  studio.apply(SaveTurntable{folder / "turn", 60, 320, 240});
  CHECK(studio.exports().doing() == "Saving the turntable turn");
  studio.apply(scene);
  CHECK(studio.exports().doing() == "Saving the turntable turn");
  std::vector<std::string> named;
  hands.app.frames_until([&] {
    const std::string now = studio.exports().doing();
    if (named.empty() || named.back() != now) named.push_back(now);
    return studio.idle();
  });
  CHECK(named.front() == "Saving the turntable turn");
  CHECK(named.back().empty());
  studio.apply(SaveTurntable{folder / "again", 60, 320, 240});
  studio.apply(scene);
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  studio.apply(SaveSnapshot{folder / "view.png"});
  const std::string picture = studio.exports().doing();
  CHECK((picture.empty() || picture == "Saving the picture view.png"));  // it may be written already
}

TEST_CASE("ui: an export that ends after another scene was opened is none of that scene") {
  const ScratchFolder folder("exported_late");
  Hands hands(false);
  hands.studio().apply(OpenScene{kSample});
  hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "all.splat"}});
  REQUIRE(hands.studio().scene()->scene->path == kSmallSample);  // which is exported, behind the other
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().scene()->scene->path == kSample);
  REQUIRE(std::filesystem::exists(folder / "all.splat"));
  CHECK(hands.studio().exports().last().empty());
  hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "of_this.splat"}});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().exports().last() == folder / "of_this.splat");
}

TEST_CASE("ui: the address of a file that is dragged out is one that other programs read") {
  CHECK(file_uri("/a b/ä%.ply") == "file:///a%20b/%C3%A4%25.ply");
  CHECK(file_uri("/plain-1_2.~/x.ply") == "file:///plain-1_2.~/x.ply");
}
