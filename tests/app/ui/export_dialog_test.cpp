// The export dialog: the name that is typed, in a folder that can be written, the format by it, and what is
// told of what is kept.
#include <doctest/doctest.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

std::filesystem::path proposed(Hands& hands) {
  hands.app.key('E', {false, true, false});
  hands.app.frames(3);
  return hands.app.interface_state().exporting.path;
}

// HOME, and whose rights files are opened with: for root every folder can be written.
class AsSomebody {
 public:
  explicit AsSomebody(const std::filesystem::path& home)
      : home_(std::getenv("HOME") ? std::getenv("HOME") : "") {
    constexpr uid_t kNobody = 65534;
    ::setenv("HOME", home.c_str(), 1);
    if (user_ == 0) REQUIRE(::seteuid(kNobody) == 0);
  }
  AsSomebody(const AsSomebody&) = delete;
  AsSomebody& operator=(const AsSomebody&) = delete;
  ~AsSomebody() {
    if (user_ == 0) CHECK(::seteuid(0) == 0);
    ::setenv("HOME", home_.c_str(), 1);
  }

 private:
  uid_t user_ = ::geteuid();
  std::string home_;
};

// The middle of what a file holds, as its text says the bounds: `words` come before three or six numbers.
glm::vec3 said_middle(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto numbers = [&](const char* words, const char* shape, float* to) {
    const std::size_t at = text.find(words);
    REQUIRE(at != std::string::npos);
    return std::sscanf(text.c_str() + at + std::string_view(words).size(), shape, to, to + 1, to + 2, to + 3,
                       to + 4, to + 5);
  };
  float n[6] = {};
  if (path.extension() == ".usda") {
    REQUIRE(numbers("extent = ", "[(%f, %f, %f), (%f, %f, %f)", n) == 6);
  } else {
    REQUIRE(numbers("\"max\":", "[%f,%f,%f", n) == 3);
    REQUIRE(numbers("\"min\":", "[%f,%f,%f", n + 3) == 3);
  }
  return {0.5f * (n[0] + n[3]), 0.5f * (n[1] + n[4]), 0.5f * (n[2] + n[5])};
}

}  // namespace

TEST_CASE("export dialog: what is typed when it opens replaces the name, not folder and ending") {
  Hands hands;
  const std::filesystem::path before = proposed(hands);
  hands.app.type("pear");
  const ExportChoice& choice = hands.app.interface_state().exporting;
  CHECK(choice.path == before.parent_path() / "pear.ply");
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  CHECK(proposed(hands) == before);  // a name of its own each time
  hands.app.type("plum");
  CHECK(choice.path == before.parent_path() / "plum.ply");
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  REQUIRE(proposed(hands) == before);
  hands.app.type("/a/whole.ply");  // replaces folder and ending, too
  CHECK(choice.path == "/a/whole.ply");
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  REQUIRE(proposed(hands) == before);
  hands.app.type("pear.spz");  // an ending takes the place of that which is there
  CHECK(choice.path == before.parent_path() / "pear.spz");
  CHECK(choice.format == SceneFormat::kSpz);
  // Another path with a slash where the name began is left as it is.
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  REQUIRE(proposed(hands) == before);
  hands.app.key('A', {.ctrl = true});
  const std::string other = "/" + std::string(before.parent_path().string().size() - 1, 'x') + "/out.ply";
  hands.app.type(other);
  CHECK(choice.path == other);
}

TEST_CASE("export dialog: a scene in a folder that cannot be written is exported to Documents, or home") {
  const ScratchFolder folder("read_only");
  namespace fs = std::filesystem;
  for (const char* name : {"scene", "home", "home/Documents"}) fs::create_directories(folder / name);
  for (const char* name : {"home", "home/Documents"}) fs::permissions(folder / name, fs::perms::all);
  fs::permissions(folder / "scene", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                        fs::perms::others_exec);
  ExportChoice choice;
  const auto goes_to = [&] {
    const AsSomebody somebody(folder / "home");
    return fs::path(proposed_path(choice, folder / "scene/room.ply", nullptr));
  };
  CHECK(goes_to() == folder / "home/Documents/room_object.ply");
  fs::remove(folder / "home/Documents");
  CHECK(goes_to() == folder / "home/room_object.ply");
  fs::permissions(folder / "home", fs::perms::owner_read | fs::perms::owner_exec);
  CHECK(goes_to() == folder / "scene/room_object.ply");  // the dialog says that it cannot be written
  fs::permissions(folder / "scene", fs::perms::all);
  CHECK(goes_to() == folder / "scene/room_object.ply");
  fs::permissions(folder / "home", fs::perms::all);
}

TEST_CASE("export dialog: the next export of a scene is proposed to go where the last one went") {
  const ScratchFolder folder("next_export");
  Hands hands;
  hands.studio().apply(Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "pear.ply"}});
  REQUIRE(hands.app.settle());
  CHECK(proposed(hands).parent_path() == folder.path());
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  hands.studio().apply(Export{{ExportWhat::kAllObjects, SceneFormat::kPly, folder / "both/all"}});
  REQUIRE(hands.app.settle());
  CHECK(proposed(hands).parent_path() == folder / "both");
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

TEST_CASE("export dialog: why the last try failed is gone as soon as anything in the dialog changes") {
  const ScratchFolder folder("stale_trouble");
  Hands hands;
  const ExportChoice& choice = hands.app.interface_state().exporting;
  const auto fail = [&] {
    proposed(hands);
    hands.app.type_into("###export", {"##path"}, (folder / "none" / "object.ply").string());
    hands.app.key(key::kEnter);
    REQUIRE(hands.app.settle());
    hands.app.frames(3);
    REQUIRE(hands.app->interface().dialog_open());
    REQUIRE(choice.trouble.find("cannot be written") != std::string::npos);
    hands.app.frames(5);
    REQUIRE_FALSE(choice.trouble.empty());  // it stays until then
  };
  const auto leave = [&] {
    hands.app->interface().make_current();
    ImGui::ClearActiveID();
    hands.app.key(key::kEscape);
    hands.app.frames(3);
    REQUIRE_FALSE(hands.app->interface().dialog_open());
  };
  for (const char* pressed : {"Everything else", ".spz", "Its foot", "+Z", "Clean edges"}) {
    CAPTURE(pressed);
    fail();
    hands.app.press_item("###export", {pressed});
    CHECK(choice.trouble.empty());
    leave();
  }
  fail();
  hands.app.type_into("###export", {"##path"}, (folder / "good").string());
  CHECK(choice.trouble.empty());
}

TEST_CASE("export dialog: the size of all objects in one file counts the byte that says whose each is") {
  const ScratchFolder folder("size_of_one_file");
  Hands hands(false);
  hands.app.key('A', {.ctrl = true});
  REQUIRE(hands.app.settle());
  const ExportChoice& choice = hands.app.interface_state().exporting;
  proposed(hands);
  hands.app.press_item("###export", {"All objects, one file"});
  hands.app.type_into("###export", {"##path"}, (folder / "all.ply").string());
  const auto planned = static_cast<std::int64_t>(choice.plan.bytes);
  hands.app.key(key::kEnter);
  REQUIRE(hands.app.settle());
  const auto written = static_cast<std::int64_t>(std::filesystem::file_size(folder / "all.ply"));
  const auto gaussians = static_cast<std::int64_t>(hands.studio().scene()->cloud->size());
  CHECK(std::abs(written - planned) < gaussians / 10);  // the header's lines are estimated
}

TEST_CASE(
    "export dialog: a typed name stays with another choice of what is written, a proposed one follows") {
  const ScratchFolder folder("typed_name");
  Hands hands;
  const ExportChoice& choice = hands.app.interface_state().exporting;
  proposed(hands);
  const std::string object = choice.path;
  hands.app.press_item("###export", {"Everything else"});
  CHECK(choice.path != object);
  hands.app.type_into("###export", {"##path"}, (folder / "mine.ply").string());
  for (const char* what : {"The object", "Everything else", "The whole scene"}) {
    hands.app.press_item("###export", {what});
    CHECK(choice.path == (folder / "mine.ply").string());
  }
  hands.app.press_item("###export", {"All objects, a file each"});
  CHECK(choice.path == (folder / "mine").string());
  hands.app.press_item("###export", {"All objects, one file"});
  CHECK(target_of(choice) == folder / "mine.ply");
  CHECK(choice.what == ExportWhat::kOneFile);
  hands.app.press_item("###export", {"The object"});
  CHECK(target_of(choice) == folder / "mine.ply");
  std::ofstream(folder / "mine.ply") << "x";
  hands.app.frames(2);
  hands.app.press_item("###export", {"Replace the file that is there"});
  CHECK(choice.overwrite);
  hands.app.press_item("###export", {"Everything else"});
  CHECK_FALSE(choice.overwrite);  // allowed for another content
}

TEST_CASE(
    "exports: a name alone goes to the folder that was proposed, not to where the program was started") {
  Hands hands = hands_on_sample();
  const std::filesystem::path folder = proposed(hands).parent_path();
  ExportChoice& choice = hands.app.interface_state().exporting;
  choice.path = "torch";
  CHECK(target_of(choice) == folder / "torch.ply");
  choice.path = "cuts/torch.ply";
  CHECK(target_of(choice) == folder / "cuts/torch.ply");
  choice.path = "/elsewhere/torch";
  CHECK(target_of(choice) == "/elsewhere/torch.ply");
  choice.path.clear();
  CHECK(target_of(choice).empty());
  choice.what = ExportWhat::kAllObjects;
  choice.path = "objects";
  CHECK(target_of(choice) == folder / "objects");
}

TEST_CASE("export dialog: cancelled it leaves clean edges as they were, exported as they are there") {
  const ScratchFolder folder("switch_kept");
  Hands hands;
  const auto clean = [&] { return hands.studio().view().clean_edges; };
  const auto open_and_untick = [&] {
    proposed(hands);
    hands.app.press_item("###export", {"Clean edges"});
    REQUIRE_FALSE(clean());
  };
  REQUIRE(clean());
  open_and_untick();
  hands.app.press_item("###export", {"Cancel"});
  CHECK(clean());
  open_and_untick();
  // Through the dialog of files and back it is the same export.
  hands.app.press_item("###export", {icon::kFolder});
  REQUIRE(hands.app.interface_state().files.open);
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  CHECK_FALSE(clean());
  hands.app->interface().make_current();
  ImGui::ClearActiveID();
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  REQUIRE_FALSE(hands.app->interface().dialog_open());
  CHECK(clean());
  open_and_untick();
  hands.app.type_into("###export", {"##path"}, (folder / "apple.ply").string());
  hands.app.key(key::kEnter);
  REQUIRE(hands.app.settle());
  CHECK(std::filesystem::exists(folder / "apple.ply"));
  CHECK_FALSE(clean());
}

TEST_CASE("export dialog: clean edges cannot be switched where the whole scene is written") {
  Hands hands(false);
  proposed(hands);
  REQUIRE(hands.app.interface_state().exporting.what == ExportWhat::kScene);
  REQUIRE(hands.studio().view().clean_edges);
  hands.app.press_item("###export", {"Clean edges"});
  CHECK(hands.studio().view().clean_edges);
}

TEST_CASE("export dialog: its folder button opens the folder that stands in the field") {
  const ScratchFolder folder("folder_of_field");
  std::filesystem::create_directories(folder / "out");
  Hands hands;
  const auto opened_from = [&](const std::filesystem::path& typed) {
    hands.app.interface_state().exporting.path = typed.string();
    hands.app.frames(2);
    hands.app.press_item("###export", {icon::kFolder});
    REQUIRE(hands.app.interface_state().files.open);
    const std::filesystem::path shown = hands.app.interface_state().files.folder;
    hands.app.key(key::kEscape);
    hands.app.frames(3);
    return shown;
  };
  proposed(hands);
  hands.app->interface().make_current();
  ImGui::ClearActiveID();
  hands.app.interface_state().exporting.name_first = false;
  CHECK(opened_from(folder / "out" / "good.ply") == folder / "out");
  CHECK(hands.app.interface_state().files.name == "good.ply");
  CHECK(opened_from(folder / "none" / "good.ply") == folder / "out");  // the last one that was there
}

TEST_CASE("export dialog: its arrows and numbers are those that a reader of the file finds there") {
  const ScratchFolder folder("export_axes");
  HeadlessApp app(1100, 620);
  app.interface_state().hint_wanted = false;
  REQUIRE(cut_out_apple(app, kSmallSample));
  UiState& state = app.interface_state();
  for (const SceneFormat& format : {SceneFormat::kGlb, SceneFormat::kUsda}) {
    const std::string named = format.name;
    CAPTURE(named);
    const auto open = [&](const std::string& file) {
      app.key('E', {.ctrl = true});
      app.frames(3);
      app->interface().make_current();
      ImGui::ClearActiveID();  // the name is being typed
      state.exporting.format = format;
      state.exporting.path = folder / (file + format.extension);
      state.exporting.placement.up = ExportUp::kPlusY;
      app.frames(2);
    };
    const auto middle_written = [&] {
      const std::filesystem::path file = state.exporting.path;
      app.key(key::kEnter);
      REQUIRE(app.settle());
      return said_middle(file);
    };
    open("plain");
    const glm::vec3 plain = middle_written();
    open("typed");
    app.type_into("###export", {"##y"}, "2");
    app.key(key::kEnter);
    const glm::vec3 typed = middle_written();
    CHECK(glm::distance(typed - plain, {0, 2, 0}) < 1e-3f);
    open("dragged");
    for (const std::size_t axis : {0u, 1u, 2u})
      for (const PlacingHandle& handle : std::vector(state.export_preview.grips.shown)) {
        if (handle.grip != PlacingGrip::kMoveAlong || handle.axis != axis) continue;
        const glm::vec2 at = 0.5f * (handle.path_px[0] + handle.path_px[1]);
        const glm::vec2 way = 0.4f * (handle.path_px[1] - handle.path_px[0]);
        app.move(at);
        app.frames(2);
        app.drag({at, at + 0.5f * way, at + way});  // towards the tip
        app.frames(2);
        break;
      }
    const glm::vec3 moved = middle_written() - typed;
    CHECK(moved.x > 0);
    CHECK(moved.y > 0);
    CHECK(moved.z > 0);
    // Where the pointer is by the time that the interface hears of the release plays no part.
    open("dropped");
    std::vector<glm::vec3> dropped;
    for (const bool goes_on : {false, true}) {
      state.exporting.placement = {};
      app.frames(3);
      const PlacingHandle handle = state.export_preview.grips.shown.front();
      const glm::vec2 at = 0.5f * (handle.path_px[0] + handle.path_px[1]);
      const glm::vec2 to = at + 0.4f * (handle.path_px[1] - handle.path_px[0]);
      app.move(at);
      app.frames(2);
      app.press(PointerButton::kLeft);
      app.frames(2);
      app.move(to);
      app.frames(2);
      app.release(PointerButton::kLeft);
      if (goes_on) app.move(at - (to - at));
      app.frames(3);
      dropped.push_back(state.exporting.placement.move);
    }
    CHECK(dropped[0] != glm::vec3(0));
    CHECK(dropped[0] == dropped[1]);
    state.exporting.placement = {};
  }
}

TEST_CASE("export dialog: where no edges are cleaned their box has no tick, and the setting stays") {
  Hands hands;
  hands.app.key('E', {false, true, false});
  hands.app.frames(3);
  const auto dialog = [&](ExportWhat what, bool clean) {
    hands.app.interface_state().exporting.what = what;
    ViewState view = hands.studio().view();
    view.clean_edges = clean;
    hands.studio().apply(SetView{view});
    REQUIRE(hands.app.settle());
    hands.app.frames(2);
    REQUIRE(hands.studio().view().clean_edges == clean);
    const UiRect area = hands.app.window("###export");
    const Image<Rgb8> picture = hands.app.picture();
    std::vector<Rgb8> pixels;  // of the left column
    for (int y = static_cast<int>(area.min.y); y < static_cast<int>(area.max.y); ++y)
      for (int x = static_cast<int>(area.min.x); x < static_cast<int>(area.min.x) + 620; ++x)
        if (picture.contains(x, y)) pixels.push_back(picture.at(x, y));
    return pixels;
  };
  for (const ExportWhat what : {ExportWhat::kOneFile, ExportWhat::kScene}) {
    CAPTURE(static_cast<int>(what));
    CHECK(dialog(what, true) == dialog(what, false));
  }
  CHECK(dialog(ExportWhat::kObject, true) != dialog(ExportWhat::kObject, false));
}
