// Opening a scene: unsaved work is asked for before it goes, what is coming is said, the first click counts,
// and a scene that cannot be opened ends nothing.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "hands.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("opening asks before unsaved work goes, dropped files and recent ones alike") {
  const ScratchFolder folder("open_asks");
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  CHECK(app.studio().unsaved());  // also before the edit is done
  REQUIRE(app.settle());
  const Document saved = app.studio().document();
  const std::uint64_t scene = app.studio().scene()->serial;
  REQUIRE(app.studio().unsaved());
  app.open(kSample);
  app.frames(3);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  CHECK(same(app.studio().document(), saved));
  CHECK(app.studio().scene()->serial == scene);
  app.open(kSample);
  app.frames(3);
  app.press_item("###open_anyway", {"Open"});
  REQUIRE(app.settle());
  CHECK(app.studio().scene()->serial != scene);
  CHECK(app.studio().document().objects.empty());
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  app.studio().apply(SaveWork{folder / "all.splatcut.json"});
  REQUIRE(app.settle());
  const std::uint64_t before = app.studio().scene()->serial;
  app.open(kSample);  // nothing would be lost
  REQUIRE(app.settle());
  CHECK(app.studio().scene()->serial != before);
}

TEST_CASE("what was to be opened is opened once the work is saved, which goes beside its own scene") {
  const ScratchFolder own("own_scene"), other("other_scene");
  for (const ScratchFolder* folder : {&own, &other})
    std::filesystem::copy_file(kSmallSample, folder->path() / kSmallSample.filename());
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(own.path() / kSmallSample.filename());
  REQUIRE(app.settle());
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  const auto scene = [&] { return app.studio().scene()->scene->path.parent_path(); };
  const auto ask = [&] {
    app.interface_state().files.folder = other.path();  // where the other one was chosen
    app.open(other.path() / kSmallSample.filename());
    app.frames(3);
    app.press_item("###open_anyway", {"Save..."});
    app.frames(3);
    REQUIRE(app.interface_state().files.saving);
    CHECK(std::filesystem::equivalent(app.interface_state().files.folder, own.path()));
  };
  ask();
  app.key(key::kEscape);  // neither saved nor opened
  REQUIRE(app.settle());
  CHECK(std::filesystem::equivalent(scene(), own.path()));
  app.studio().apply(SaveWork{own / "by_itself.splatcut.json"});
  REQUIRE(app.settle());
  CHECK(std::filesystem::equivalent(scene(), own.path()));
  app.studio().apply(EditSelection{SelectionEdit::kInvert});
  REQUIRE(app.settle());
  ask();
  app.studio().apply(Undo{});  // back to what is saved: it was not this that should be saved before
  REQUIRE(app.settle());
  CHECK(std::filesystem::equivalent(scene(), own.path()));
  app.key(key::kEscape);
  app.studio().apply(Redo{});
  REQUIRE(app.settle());
  ask();
  CHECK(app.interface_state().files.name == "by_itself.splatcut.json");
  app.key(key::kEnter);
  app.frames(3);
  REQUIRE(app.settle());
  CHECK(std::filesystem::equivalent(scene(), other.path()));
  CHECK_FALSE(app.studio().unsaved());
}

TEST_CASE("a scene that cannot be opened leaves the cut and the preparing that it stopped to go on") {
  const ScratchFolder folder("cannot_be_opened");
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(kSample);
  while (!app.studio().scene()) app.frames(1);
  app.studio().apply(OpenScene{folder / "nowhere.ply"});  // while it is prepared
  REQUIRE(app.settle());
  CHECK(app.studio().scene());
  app.click(app.screen_of(kOnApple));
  app.studio().apply(OpenScene{folder / "nowhere.ply"});  // while it is cut
  REQUIRE(app.settle());
  CHECK(app.studio().cuts().cutting() == 0);
  CHECK(app.studio().gaussians_of(app.studio().document().active) > 0);
}

TEST_CASE("hands: a new scene begins with the click tool, an ordinary brush and the whole scene") {
  Hands hands;
  ViewState view = hands.studio().view();
  view.tool = Tool::kBrush;
  view.operation = SetOperation::kRemove;
  view.brush_px = kMostBrushPx;
  hands.studio().apply(SetView{view});
  hands.studio().apply(OpenScene{kSmallSample});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().view().tool == Tool::kClick);
  CHECK(hands.studio().view().operation == SetOperation::kAdd);
  CHECK(hands.studio().view().brush_px <= kMostKeptBrushPx);
}

TEST_CASE("hands: a click at the moment when a scene opens is cut") {
  HeadlessApp app(kHandsWidth, kHandsHeight);
  app.frames(1);
  app.open(kSmallSample);
  while (!app.studio().scene()) app.studio().update(1.0 / 60);
  app.studio().apply(
      AddStroke{app.studio().viewport().pane_camera(),
                click(app.screen_of(kOnApple) - app->interface().viewport().min, SeedLabel::kObject)});
  REQUIRE(app.settle());
  CHECK(app.studio().gaussians_of(app.studio().document().active) > 20);
}

TEST_CASE("hands: Enter saves work where a scene would be opened over it, and discards nothing") {
  Hands hands;
  const std::uint64_t serial = hands.studio().scene()->serial;
  hands.app.open(kSmallSample);
  hands.app.frames(3);
  REQUIRE(hands.app->interface().dialog_open());
  hands.app.key(key::kEnter);
  hands.app.frames(3);
  CHECK(hands.app->interface().dialog_open());  // where to save
  CHECK(hands.app.interface_state().files.saving);
  hands.app.key(key::kEscape);
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->serial == serial);
}

TEST_CASE("a view that has no picture yet says what is coming, and no more once it is there") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  CHECK(app.studio().coming().empty());
  app.open(kSmallSample);
  CHECK(app.studio().coming() == "Opening small_sample.compressed.ply");
  app.frames(1);
  CHECK(app.button("Open a file").size().x == 0);  // nothing else is to be chosen now
  while (!app.studio().scene()) app.frames(1);
  REQUIRE(!app.studio().viewport().picture());
  CHECK(app.studio().coming() == "Drawing the first picture...");
  REQUIRE(app.settle());
  CHECK(app.studio().coming().empty());
}

TEST_CASE("opening what cannot be read ends no work, and the question before says so") {
  const ScratchFolder folder("open_text");
  std::ofstream(folder / "text.ply") << "no scene";
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  const Document work = app.studio().document();
  app.open(folder / "text.ply");
  app.frames(3);
  app.press_item("###open_anyway", {"Open"});
  REQUIRE(app.settle());
  CHECK(app.studio().messages().back().text.find("text.ply: this is not a .ply file") != std::string::npos);
  CHECK(same(app.studio().document(), work));
  CHECK(app.studio().unsaved());
}

TEST_CASE(
    "a folder with one scene file is opened as that file, with the cameras beside it, and it is named") {
  const ScratchFolder folder("folder_of_one");
  std::filesystem::copy_file(kSmallSample, folder.path() / kSmallSample.filename());
  std::filesystem::copy_file(kSampleFolder / "cameras.json", folder / "cameras.json");
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(folder.path());
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  CHECK(app.studio().scene()->scene->path == folder / kSmallSample.filename());
  CHECK_FALSE(app.studio().scene()->views().cameras.empty());
  CHECK(std::ranges::any_of(app.studio().messages(), [](const Message& message) {
    return message.text.find("the only scene in the folder") != std::string::npos;
  }));
}
