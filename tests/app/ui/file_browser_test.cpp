// The built-in dialog for files: names and paths that are typed, keys, double-clicks, what is saved and what
// is replaced.
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "hands.h"

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
  const auto save_as = [&](std::string_view text) {
    files.folder = folder.path();
    app.key('S', {.ctrl = true});
    app.frames(3);
    REQUIRE(files.open);
    app.type(text);
  };
  save_as("b");
  CHECK(files.name == "b");
  app.type("eta");
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

TEST_CASE("hands: a file is found by its first letters, by arrows, and opened by Enter") {
  const ScratchFolder folder("browse");
  std::filesystem::create_directories(folder / "garden");
  for (const char* name : {"alpha.ply", "beta.ply", "bicycle.ply"}) std::ofstream(folder / name) << "x";
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = folder.path();
  app.key('O', {.ctrl = true});
  app.frames(2);
  REQUIRE(files.open);
  REQUIRE(files.entries.size() == 4);
  app.type("b");
  CHECK(files.name == "beta.ply");
  app.type("i");
  CHECK(files.name == "bicycle.ply");
  app.key(key::kUp);
  CHECK(files.name == "beta.ply");
  app.key(key::kHome);
  CHECK(files.cursor == 0);
  app.key(key::kEnter);  // the folder
  app.frames(2);
  REQUIRE(files.entries.size() == 1);
  app.key(key::kDown);
  CHECK(files.name == "mug.compressed.ply");
  app.key(key::kEnter);
  CHECK_FALSE(files.open);
  REQUIRE(app.settle());
  CHECK(app.studio().scene() != nullptr);
}

TEST_CASE("hands: a path is typed as soon as the dialog is open, and Enter opens it") {
  const ScratchFolder folder("typed_path");
  std::filesystem::create_directories(folder / "garden");
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  for (const bool whole : {true, false}) {
    CAPTURE(whole);
    files.folder = whole ? std::filesystem::temp_directory_path() : folder.path();
    app.key('O', {.ctrl = true});
    app.frames(3);
    REQUIRE(files.open);
    if (whole) {
      app.type((folder / "garden").string());
      app.key(key::kEnter);
      app.frames(3);
      REQUIRE(files.open);
      CHECK(files.folder.filename() == "garden");
      app.type("mu");  // the beginning of a name
      CHECK(files.name == "mug.compressed.ply");
    } else {
      app.type("garden/mug.compressed.ply");  // from the folder that is shown
    }
    const std::uint64_t before = app.studio().scene() ? app.studio().scene()->serial : 0;
    app.key(key::kEnter);
    CHECK_FALSE(files.open);
    REQUIRE(app.settle());
    REQUIRE(app.studio().scene());
    CHECK(app.studio().scene()->serial != before);
  }
}

TEST_CASE("hands: a whole path is completed as a name is") {
  const ScratchFolder folder("whole_path");
  std::filesystem::create_directories(folder / "garden");
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = std::filesystem::current_path();
  app.key('O', {.ctrl = true});
  app.frames(3);
  app.type((folder / "gar").string());
  CHECK(std::filesystem::equivalent(files.folder, folder.path()));
  REQUIRE(files.cursor >= 0);
  CHECK(files.entries[static_cast<std::size_t>(files.cursor)].name == "garden");
  app.type("den/mu");
  CHECK(files.typed_folder == (folder / "garden" / "mu").string());
  CHECK(files.name == "mug.compressed.ply");
  app.key(key::kEnter);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
}

TEST_CASE("hands: Tab goes from the path to the list of files, and Enter opens what it marks") {
  const ScratchFolder folder("tab_to_list");
  for (const char* name : {"alpha.compressed.ply", "beta.compressed.ply"})
    std::filesystem::copy_file(kSmallSample, folder / name);
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = folder.path();
  app.key('O', {.ctrl = true});
  app.frames(3);
  for (int i = 0; i < 2; ++i) {
    app.key(key::kTab);
    app.frames(20);
  }
  app.key(key::kEnter);
  app.frames(3);
  CHECK_FALSE(files.open);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  CHECK(app.studio().scene()->scene->path.filename() == "beta.compressed.ply");
}

TEST_CASE("dialogs: places of one name are told apart by the folders that they are in") {
  using Names = std::vector<std::string>;
  CHECK(names_of_folders({"/a/bank2/scenes", "/a/bank3/scenes", "/a/other"}) ==
        Names{"scenes (bank2)", "scenes (bank3)", "other"});
  CHECK(names_of_folders({"/a/one/bank/scenes", "/a/two/bank/scenes"}) ==
        Names{"scenes (one/bank)", "scenes (two/bank)"});
  CHECK(names_of_folders({"/a/scenes"}) == Names{"scenes"});
}
