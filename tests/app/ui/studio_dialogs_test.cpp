// Files asked for in dialogs: the desktop's own (a stand-in of it), the one inside; numbers typed in panels.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "headless_app.h"
#include "only_path.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The desktop's dialog is the only child of this process. Its end is left to the program to meet.
void wait_for_answer(HeadlessApp& app) {
  siginfo_t ended;
  ::waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT);  // no child: it was met already
  app.frames(3);
  REQUIRE(app.settle());
}

void open_with_unsaved_work(HeadlessApp& app) {
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
}

}  // namespace

TEST_CASE("dialogs: zenity's answer opens the scene, kdialog's too, and it is asked for the right thing") {
  for (const std::string program : {"zenity", "kdialog"}) {
    CAPTURE(program);
    const ScratchFolder folder("native_" + program);
    const OnlyPath path(folder.path());
    path.put(program, "echo '" + kSmallSample.string() + "'");
    HeadlessApp app(760, 420);
    app.interface_state().native_wanted = true;
    app.key('O', {.ctrl = true});
    wait_for_answer(app);
    CHECK_FALSE(app->interface().dialog_open());
    REQUIRE(app.settle());
    REQUIRE(app.studio().scene());
    CHECK(app.studio().scene()->scene->path == kSmallSample);
    CHECK(path.asked().find(program) != std::string::npos);
    CHECK(path.asked().find("*.splatcut.json") != std::string::npos);
  }
}

TEST_CASE("dialogs: work is saved where the desktop's dialog says, with the ending it needs") {
  const ScratchFolder folder("native_save");
  HeadlessApp app(760, 420);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const OnlyPath path(folder.path());
  path.put("zenity", "echo '" + (folder / "mine").string() + "'");
  app.interface_state().native_wanted = true;
  app.key('S', {.ctrl = true});
  wait_for_answer(app);
  CHECK(std::filesystem::exists(folder / "mine.splatcut.json"));
  CHECK(path.asked().find("--save\n") != std::string::npos);
}

TEST_CASE(
    "dialogs: a cancelled one changes nothing; one that fails, and none at all, give the built-in one") {
  const ScratchFolder folder("native_none");
  const OnlyPath path(folder.path());
  HeadlessApp app(760, 420);
  app.interface_state().native_wanted = true;
  path.put("zenity", "exit 1");
  app.key('O', {.ctrl = true});
  wait_for_answer(app);
  CHECK_FALSE(app->interface().dialog_open());
  CHECK_FALSE(app.studio().scene());
  path.put("zenity", "exit 255");
  app.key('O', {.ctrl = true});
  wait_for_answer(app);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  app.frames(2);
  CHECK_FALSE(app->interface().dialog_open());
  std::filesystem::remove(folder / "zenity");
  app.key('O', {.ctrl = true});
  app.frames(2);
  CHECK(app->interface().dialog_open());
}

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

TEST_CASE("dialogs: Enter and Esc in a number end the number, not the dialog") {
  const ScratchFolder folder("numbers");
  HeadlessApp app(760, 520);
  REQUIRE(cut_out_apple(app));
  UiState& state = app.interface_state();
  app.key('E', {.ctrl = true});
  app.frames(3);
  app->interface().make_current();
  ImGui::ClearActiveID();  // the name is being typed
  state.exporting.path = (folder / "object.ply").string();
  app.type_into("###export", {"##turn"}, "30");
  app.key(key::kEnter);
  app.frames(3);
  CHECK(state.exporting.placement.turn_deg == 30);
  CHECK(app->interface().dialog_open());
  app.type_into("###export", {"##scale"}, "3");
  app.key(key::kEscape);
  app.frames(3);
  CHECK(state.exporting.placement.scale == 1);
  CHECK(app->interface().dialog_open());
  app.type_into("###export", {"##path"}, (folder / "turned.ply").string());
  app.key(key::kEnter);
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  CHECK_FALSE(std::filesystem::exists(folder / "object.ply"));
  CHECK(std::filesystem::exists(folder / "turned.ply"));
  state.turntable_open = true;
  app.frames(3);
  app.type_into("###turntable", {"##frames"}, "5");
  app.key(key::kEnter);
  app.frames(3);
  CHECK(state.turntable.frames == 5);
  CHECK(app->interface().dialog_open());
  app.type_into("###turntable", {"##width"}, "77");
  app.key(key::kEscape);
  app.frames(3);
  CHECK(state.turntable.width_px != 77);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  app.frames(3);
  CHECK_FALSE(app->interface().dialog_open());
}

TEST_CASE("dialogs: keys that are pressed and released between two frames count, in their order") {
  const ScratchFolder folder("quick");
  HeadlessApp app(760, 520);
  REQUIRE(cut_out_apple(app));
  app.key('E', {.ctrl = true});
  app.frames(3);
  app.type_into("###export", {"##path"}, "/wrong");
  const auto tap = [&](int code, const Modifiers& modifiers = {}) {
    app->handle(KeyChanged{code, true, false, modifiers});
    app->handle(KeyChanged{code, false, false, modifiers});
  };
  app->handle(KeyChanged{key::kLeftControl, true, false, {}});
  tap('A', {.ctrl = true});
  app->handle(KeyChanged{key::kLeftControl, false, false, {.ctrl = true}});
  const auto type = [&](const std::string& text) {
    for (const char c : text) {
      app->handle(KeyChanged{c, true, false, {}});
      app->handle(TextTyped{static_cast<unsigned>(c)});
      app->handle(KeyChanged{c, false, false, {}});
    }
  };
  type((folder / "right.ply").string());
  tap(key::kEnter);
  app.frames(5);
  CHECK(app.interface_state().exporting.path == (folder / "right.ply").string());
  tap(key::kEnter);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "right.ply"));
  // A button that is pressed after the name comes after it.
  app.key('E', {.ctrl = true});
  app.frames(3);
  const UiRect dialog = app.window("###export");
  const auto& items = app.interface_state().items;
  const auto button = std::ranges::find_if(
      items, [&](const ShownItem& i) { return i.name == "Export" && dialog.contains(i.min); });
  REQUIRE(button != items.end());
  const glm::vec2 on_button = 0.5f * (button->min + button->max);
  app.type_into("###export", {"##path"}, "/wrong");
  app->handle(KeyChanged{key::kLeftControl, true, false, {}});
  tap('A', {.ctrl = true});
  app->handle(KeyChanged{key::kLeftControl, false, false, {.ctrl = true}});
  type((folder / "pressed.ply").string());
  app.move(on_button);
  app.press(PointerButton::kLeft);
  app.release(PointerButton::kLeft);
  REQUIRE(app.settle());
  app.frames(4);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "pressed.ply"));
}

TEST_CASE("dialogs: a second scene, and all of both is exported without an object") {
  const ScratchFolder folder("whole");
  HeadlessApp app(760, 520);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.key('O', {.shift = true, .ctrl = true});
  app.frames(3);
  FileBrowser& files = app.interface_state().files;
  REQUIRE(files.open);
  files.enter(kSmallSample.parent_path());
  files.name = kSmallSample.filename().string();
  app.key(key::kEnter);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene()->files.size() == 2);
  app.key('E', {.ctrl = true});
  app.frames(3);
  app.type_into("###export", {"##path"}, (folder / "both.ply").string());
  app.key(key::kEnter);
  REQUIRE(app.settle());
  CHECK(load_scene(folder / "both.ply").cloud.size() == app.studio().scene()->cloud->size());
}

TEST_CASE("dialogs: an export is named as its format is, whatever was typed") {
  const ScratchFolder folder("named");
  HeadlessApp app(760, 520);
  REQUIRE(cut_out_apple(app));
  UiState& state = app.interface_state();
  const auto export_as = [&](const std::string& name) {
    app.key('E', {.ctrl = true});
    app.frames(3);
    app.type_into("###export", {"##path"}, (folder / name).string());
    app.key(key::kEnter);
    REQUIRE(app.settle());
    CHECK_FALSE(app->interface().dialog_open());
  };
  export_as("without");
  CHECK(state.exporting.format == SceneFormat::kPly);
  CHECK(load_scene(folder / "without.ply").format == SceneFormat::kPly);
  export_as("small.spz");
  CHECK(load_scene(folder / "small.spz").format == SceneFormat::kSpz);
  export_as("picture.png");
  CHECK(load_scene(folder / "picture.png.spz").format == SceneFormat::kSpz);
  const Export wrong{{ExportWhat::kObject, SceneFormat::kPly, folder / "wrong.spz", true}};
  app.studio().apply(wrong);
  REQUIRE(app.settle());
  CHECK(app.studio().messages().back().text.find("does not end with .ply") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "wrong.spz"));
}

TEST_CASE("dialogs: Esc where a folder is chosen goes back to the export, which stays") {
  HeadlessApp app(760, 520);
  REQUIRE(cut_out_apple(app));
  for (const bool turntable : {false, true}) {
    CAPTURE(turntable);
    UiState& state = app.interface_state();
    (turntable ? state.turntable_open : state.export_open) = true;
    app.frames(3);
    app.press_item(turntable ? "###turntable" : "###export", {icon::kFolder});
    REQUIRE(state.files.open);
    app.key(key::kEscape);
    app.frames(3);
    CHECK_FALSE(state.files.open);
    CHECK((turntable ? state.turntable_open : state.export_open));
    app.key(key::kEscape);
    app.frames(3);
    CHECK_FALSE(app->interface().dialog_open());
  }
}

TEST_CASE("dialogs: what an export keeps and loses is told as it is written, moved or not") {
  const ScratchFolder folder("kept");
  {
    Scene plain = load_scene(kSmallSample);
    save_scene(folder / "plain.ply", plain, {}, SceneFormat::kPly);
    std::filesystem::copy_file(kSmallSample.parent_path() / "cameras.json", folder / "cameras.json");
  }
  HeadlessApp app(760, 520);
  app.open(folder / "plain.ply");
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene()->scene->rows_can_be_copied);
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  UiState& state = app.interface_state();
  app.key('E', {.ctrl = true});
  app.frames(3);
  CHECK(state.exporting.plan.kept.find("byte for byte") == std::string::npos);  // with clean edges
  ViewState view = app.studio().view();
  view.clean_edges = false;
  app.studio().apply(SetView{view});
  app.frames(3);
  CHECK(state.exporting.plan.kept.find("byte for byte") != std::string::npos);
  state.exporting.placement.turn_deg = 30;
  app.frames(2);
  CHECK(state.exporting.plan.kept.find("byte for byte") == std::string::npos);
  state.exporting.placement.turn_deg = 0;
  app.frames(2);
  CHECK(state.exporting.plan.kept.find("byte for byte") != std::string::npos);
}

TEST_CASE("panels: a number is typed in the unit it is shown in") {
  HeadlessApp app(900, 1300);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const ViewState& view = app.studio().view();
  const float size = app.studio().camera().scene_size();
  const auto typed = [&](const char* window, std::initializer_list<const char*> names, float value) {
    app.type_into(window, names, fmt::format("{:.5f}", value));
    app.key(key::kEnter);
    app.frames(3);
  };
  const char* side = "side/scroll";
  app.press_item(side, {"View"});
  app.press_item(side, {"Repair by hand"});
  const float near_plane = 3 * app.studio().viewport().draw_limits().near_plane;
  typed(side, {"##near"}, near_plane);
  CHECK(app.studio().viewport().draw_limits().near_plane == doctest::Approx(near_plane).epsilon(1e-3));
  typed(side, {"##far"}, 1.5f * size);
  CHECK(app.studio().viewport().draw_limits().far_plane == doctest::Approx(1.5f * size).epsilon(1e-3));
  PropertyChoice& property = app.interface_state().property;
  property.property = 0;
  app.frames(2);
  typed(side, {"##range", "##min"}, 30);
  CHECK(property.low == doctest::Approx(0.3f).epsilon(1e-3));
  property.property = 1;
  app.frames(2);
  typed(side, {"##range", "##max"}, 0.02f);
  CHECK(property.high == doctest::Approx(std::log10(0.02f)).epsilon(1e-3));
  property.property = PropertyChoice::kColourProperty;
  app.frames(2);
  typed(side, {"##tolerance"}, 25);
  CHECK(property.tolerance == doctest::Approx(0.25f));
  app.key('C');
  app.frames(2);
  typed("options", {"##tolerance"}, 35);  // below the bar, which has no room for them here
  CHECK(view.colour_tolerance == doctest::Approx(0.35f));
  app.key('7');
  app.key('V');
  app.frames(2);
  REQUIRE(view.see_through);
  typed("options", {"##depth"}, 0.125f * size);
  CHECK(view.depth_limit == doctest::Approx(0.125f).epsilon(1e-3));
}
