// The built-in dialog for files: names and folders that are typed, what is saved and what is replaced.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string_view>

#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void open_with_unsaved_work(HeadlessApp& app) {
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
}

}  // namespace

TEST_CASE(
    "dialogs: typing a name to save under chooses no file, and a file is replaced only where asked to") {
  const ScratchFolder folder("save_over");
  const auto there = folder / "beta.splatcut.json";
  std::ofstream(there) << "x";
  HeadlessApp app(760, 420);
  open_with_unsaved_work(app);
  FileBrowser& files = app.interface_state().files;
  const auto type = [&](std::string_view text) {
    for (const char c : text) {
      app->handle(TextTyped{static_cast<unsigned>(c)});
      app.frames(1);
    }
  };
  const auto save_as = [&](std::string_view text) {
    files.folder = folder.path();
    app.key('S', {.ctrl = true});
    app.frames(3);
    REQUIRE(files.open);
    type(text);
  };
  save_as("b");
  CHECK(files.name == "b");
  type("eta");
  CHECK(files.name == "beta");
  app.key(key::kEnter);
  app.frames(3);
  CHECK(std::filesystem::file_size(there) == 1);
  REQUIRE(app->interface().dialog_open());
  app.key(key::kEnter);  // keeps it, and asks for another name
  app.frames(3);
  CHECK(std::filesystem::file_size(there) == 1);
  CHECK(files.open);
  app.key(key::kEscape);
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  save_as("beta");
  app.key(key::kEnter);
  app.frames(3);
  app.press_item("###replace", {"Replace"});
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  CHECK(std::filesystem::file_size(there) > 1);
  // The work's own file.
  save_as("beta");
  app.key(key::kEnter);
  app.frames(3);
  CHECK_FALSE(app->interface().dialog_open());
  save_as("gamma");
  app.key(key::kEnter);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "gamma.splatcut.json"));
}

TEST_CASE("dialogs: Save... where the program would be left saves the work, then leaves") {
  const ScratchFolder folder("save_and_leave");
  HeadlessApp app(760, 420);
  open_with_unsaved_work(app);
  FileBrowser& files = app.interface_state().files;
  const auto ask_to_save = [&] {
    files.folder = folder.path();
    app.studio().run(Action::kQuit);
    app.frames(3);
    REQUIRE(app->interface().dialog_open());
    app.key(key::kEnter);
    app.frames(3);
    REQUIRE(files.open);
  };
  const auto save = [&] {
    app.key(key::kEnter);
    REQUIRE(app.settle());
    app.frames(2);
  };
  ask_to_save();
  app.key(key::kEscape);  // not saved after all
  app.frames(3);
  files.folder = folder.path();
  app.key('S', {.ctrl = true});  // a save by itself ends nothing
  app.frames(3);
  save();
  CHECK(std::filesystem::exists(folder / "small_sample.splatcut.json"));
  CHECK_FALSE(app->wants_to_close());

  app.studio().apply(EditSelection{SelectionEdit::kInvert});
  REQUIRE(app.settle());
  ask_to_save();
  save();
  CHECK_FALSE(app.studio().unsaved());
  CHECK(app->wants_to_close());
}

TEST_CASE("dialogs: a folder typed where something is saved leaves the file's name as it is") {
  const ScratchFolder folder("typed");
  std::filesystem::create_directories(folder / "out");
  std::ofstream(folder / "old.splatcut.json") << "{}";
  FileBrowser files;
  files.extensions = {".splatcut.json"};
  files.saving = true;
  files.name = "mug.splatcut.json";
  files.enter(folder.path());
  for (const char* typed : {"o", "old", "out"}) {
    files.typed_folder = (folder / typed).string();
    files.follow_typed();
    CHECK(files.name == "mug.splatcut.json");
  }
}

TEST_CASE("dialogs: a double-click on a folder goes into it, and chooses nothing there") {
  const ScratchFolder folder("double");
  std::filesystem::create_directories(folder / "garden");
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(760, 420);
  FileBrowser& files = app.interface_state().files;
  files.folder = folder.path();
  app.key('O', {.ctrl = true});
  app.frames(3);
  REQUIRE(files.entries.size() == 1);
  const UiRect rows = app.window("###files/entries");
  app.move(rows.min + glm::vec2(40, 16));
  const auto press = [&](double time_s) {
    app->handle(PointerButtonChanged{PointerButton::kLeft, true, {}, time_s});
    app.frames(1);
    app->handle(PointerButtonChanged{PointerButton::kLeft, false, {}, time_s + 0.05});
    app.frames(2);
  };
  press(100);
  CHECK(files.folder.filename() == "garden");
  press(100.2);
  CHECK(files.open);
  CHECK(app.studio().scene() == nullptr);
  press(102);
  press(102.2);
  CHECK_FALSE(files.open);
  REQUIRE(app.settle());
  CHECK(app.studio().scene());
}
