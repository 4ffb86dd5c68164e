// Work that is saved by itself, and offered after a crash: when, in which order, beside another program.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "app/work/autosaves.h"
#include "app/work/work_file.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// What a worker writes, waited for without a frame of the program.
bool is_written(const std::filesystem::path& file) {
  for (int i = 0; i < 200 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return std::filesystem::exists(file);
}

}  // namespace

TEST_CASE("work is saved by itself and offered after a crash") {
  const ScratchFolder folder("state");
  Document saved;
  CameraPose pose;
  {
    ApplicationOptions options = with_state(folder);
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    CHECK(app.studio().work().offers().empty());
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    app.frames(60 * 3);
    REQUIRE(app.settle());
    saved = app.studio().document();
    app.studio().camera().orbit({60, 20});  // the view alone
    pose = app.studio().camera().kept_pose();
    app.frames(60 * 11);
    REQUIRE(app.settle());
  }  // no leave(): as if it had crashed
  REQUIRE(std::filesystem::exists(folder / "autosave.splatcut.json"));
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  CHECK(!app.studio().work().offers().empty());
  CHECK(app.studio().work().offers().front().says.ends_with("  sample/sample.compressed.ply"));
  // Started with a scene and worked on: what is offered is still there.
  opened(app);
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  app.frames(60 * 3);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "autosave.splatcut.json"));
  CHECK(app.studio().work().own_autosave() == folder / "autosave.2.splatcut.json");
  CHECK(std::filesystem::exists(folder / "autosave.2.splatcut.json"));
  REQUIRE(app.studio().work().offers().size() == 1);
  const std::string says = app.studio().work().offers().front().says;
  app.studio().apply(OpenScene{app.studio().work().offers().front().file});
  REQUIRE(app.settle());
  CHECK(same(app.studio().document(), saved));
  CHECK(app.studio().camera().pose() == pose);
  CHECK(std::ranges::any_of(app.studio().messages(),
                            [&](const Message& m) { return m.text == "Restoring unsaved work: " + says; }));
  CHECK(std::ranges::any_of(app.studio().messages(), [](const Message& m) {
    return m.kind == Message::Kind::kDone && m.text.find("restored") != m.text.npos;
  }));
  CHECK(app.studio().work().offers().size() == 1);  // the orange, which it took the place of
  CHECK(app.studio().unsaved());                    // it is nowhere else yet
  app.frames(60 * 3);
  REQUIRE(app.settle());
  app.studio().leave();
  const std::filesystem::path own = app.studio().work().own_autosave();
  REQUIRE(std::filesystem::exists(own));
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.splatcut.json"));  // it is in the other now
  const auto again = open_scene(read_work_file(own).files);
  CHECK(same(restored(read_work_file(own), *again).document, saved));
}

TEST_CASE("a cut is saved by itself within a second of its answer, while pictures of it are made") {
  const ScratchFolder folder("soon");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  opened(app);
  app.click(app.screen_of(kOnApple));
  Studio& studio = app.studio();
  while (studio.gaussians_of(studio.document().active) == 0) app.frames(1);  // in the middle of its work
  const auto kept = [&] {
    if (!std::filesystem::exists(studio.work().own_autosave())) return false;
    const WorkFile work = read_work_file(studio.work().own_autosave());
    const nlohmann::json& objects = (*work.content)["objects"];
    return !objects.empty() && objects[0]["cut_is_current"].get<bool>();
  };
  for (int tenth = 0; tenth < 8; ++tenth) {  // of a second of the program's clock
    app->frame(0.1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (int i = 0; i < 400 && !kept(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(kept());
  REQUIRE(app.settle());
}

TEST_CASE("steady work is saved by itself, though it never rests") {
  const ScratchFolder folder("steady");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  opened(app);
  const std::filesystem::path own = app.studio().work().own_autosave();
  for (int fifth = 0; fifth < 15; ++fifth) {  // of a second; a step in each
    app.studio().apply(EditSelection{fifth == 0 ? SelectionEdit::kAll : SelectionEdit::kInvert});
    app->frame(0.2);
  }
  CHECK(is_written(own));
  REQUIRE(app.settle());
}

TEST_CASE("work is saved by itself while a file is read, and where the program is left before it was") {
  const ScratchFolder folder("reading");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  opened(app);
  Studio& studio = app.studio();
  const std::filesystem::path own = studio.work().own_autosave();
  const auto objects_kept = [&] {
    REQUIRE(is_written(own));
    return (*read_work_file(own).content)["objects"].size();
  };
  studio.apply(NewObject{});
  studio.apply(AddScene{kSmallSample});
  REQUIRE(studio.loading());
  app->frame(0.5);
  CHECK(objects_kept() == 1);
  REQUIRE(app.settle());
  app.frames(60);
  REQUIRE(app.settle());
  std::filesystem::remove(own);
  studio.apply(NewObject{});
  studio.leave();
  CHECK(objects_kept() == 2);
}

TEST_CASE("work of a program that a signal ends is offered as it was, without a moment for saving it") {
  const ScratchFolder folder("state_signal");
  ApplicationOptions options = with_state(folder);
  Document saved;
  CameraPose pose;
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    opened(app);
    app.studio().keep_unsaved();  // there is nothing
    CHECK_FALSE(std::filesystem::exists(app.studio().work().own_autosave()));
    app.studio().apply(EditSelection{SelectionEdit::kAll});
    REQUIRE(app.settle());
    app.studio().camera().orbit({60, 20});
    app.click(app.screen_of(kOnApple));  // whose cut has just begun
    saved = app.studio().document();
    pose = app.studio().camera().kept_pose();
    app.studio().keep_unsaved();
  }
  {  // restored and ended again before it is saved by itself: offered once
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    app.studio().apply(OpenScene{app.studio().work().offers().front().file});
    while (!app.studio().scene()) app.frames(1);
    app.studio().keep_unsaved();
  }
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
  REQUIRE(!app.studio().work().offers().empty());
  const std::filesystem::path offered = app.studio().work().offers().front().file;
  std::size_t works = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    works += entry.path().filename().string().ends_with(".splatcut.json");
  CHECK(works == 1);
  app.studio().apply(OpenScene{offered});
  REQUIRE(app.settle());
  Document now = app.studio().document();
  for (ObjectItem& o : now.objects) {  // cut again from its strokes
    CHECK(o.cut != nullptr);
    o.cut = nullptr;
    o.cut_key.clear();
  }
  CHECK(same(now, saved));
  CHECK(app.studio().camera().kept_pose() == pose);
}

TEST_CASE("work of a program that ends a little later is offered, too") {
  const ScratchFolder folder("state_held");
  const auto scene = open_scene(kSample);
  Document document;
  add_object(&document, "mug");
  write_work_file(folder / "autosave.splatcut.json", *scene, document);
  const int lock = ::open((folder / "autosave.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  REQUIRE(lock >= 0);
  REQUIRE(::flock(lock, LOCK_EX | LOCK_NB) == 0);  // as the other program holds it
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  app.frames(60 * 3);
  CHECK(app.studio().work().offers().empty());
  ::close(lock);
  app.frames(60 * 3);
  CHECK(!app.studio().work().offers().empty());
  CHECK(app.studio().work().offers().front().says.ends_with("  sample/sample.compressed.ply"));
}

TEST_CASE("of several works left by crashes, that of the open scene is offered first, then the newest") {
  const ScratchFolder folder("state_several");
  const auto left = [&](const char* name, const std::filesystem::path& scene, int hours_ago) {
    Document document;
    add_object(&document, name);
    write_work_file(folder / name, *open_scene(scene), document);
    std::filesystem::last_write_time(
        folder / name, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours_ago));
  };
  left("autosave.splatcut.json", kSmallSample, 5);
  left("autosave.2.splatcut.json", kSample, 3);
  left("autosave.3.splatcut.json", kSample, 4);
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  const auto order = [&] {
    std::string numbers;
    for (const LeftWork& work : app.studio().work().offers())
      numbers += work.file == folder / "autosave.splatcut.json"     ? "1"
                 : work.file == folder / "autosave.2.splatcut.json" ? "2"
                                                                    : "3";
    return numbers;
  };
  CHECK(order() == "231");
  app.open(kSmallSample);
  REQUIRE(app.settle());
  CHECK(order() == "123");
  app.studio().apply(DropAutosave{folder / "autosave.2.splatcut.json"});
  CHECK(order() == "13");
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.2.splatcut.json"));
  app.studio().apply(DropAutosave{folder / "autosave.2.splatcut.json"});
  CHECK(app.studio().messages().back().kind == Message::Kind::kRefused);
}

TEST_CASE("work that was saved by itself stays offered where its scene cannot be opened") {
  const ScratchFolder folder("state_without_scene");
  const auto moved = folder / "moved.compressed.ply";
  std::filesystem::copy_file(kSample, moved);
  const auto scene = open_scene(moved);
  Document document;
  add_object(&document, "mug");
  write_work_file(folder / "autosave.splatcut.json", *scene, document);
  std::filesystem::rename(moved, folder / "elsewhere");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  app.studio().apply(OpenScene{app.studio().work().offers().front().file});
  REQUIRE(app.settle());
  CHECK(app.studio().messages().back().text.find("moved.compressed.ply") != std::string::npos);
  CHECK(!app.studio().work().offers().empty());
  std::filesystem::rename(folder / "elsewhere", moved);
  app.studio().apply(OpenScene{app.studio().work().offers().front().file});
  REQUIRE(app.settle());
  CHECK(app.studio().document().objects.size() == 1);
  CHECK(app.studio().work().offers().empty());
}

TEST_CASE("work that could not be saved by itself is saved once it can be, without another change") {
  const ScratchFolder folder("full");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  opened(app);
  const std::filesystem::path own = app.studio().work().own_autosave();
  std::filesystem::create_directory(own);  // where the file should go
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  const auto refusals = [&] {
    return std::ranges::count(app.studio().messages(), Message::Kind::kError, &Message::kind);
  };
  const auto wait = [&](int seconds) {
    for (int s = 0; s < seconds; ++s) {
      app->frame(1);
      REQUIRE(app.settle());
    }
  };
  wait(5);
  CHECK(refusals() == 1);  // said, but not every two seconds
  std::filesystem::remove(own);
  wait(40);
  CHECK(std::filesystem::is_regular_file(own));
  CHECK(refusals() == 1);
}

TEST_CASE("two programs save by themselves beside each other, neither offers what the other works on") {
  const ScratchFolder folder("two_programs");
  const auto left_after = [&](const char* name) {  // by a program that crashed
    const auto scene = open_scene(kSample);
    Document document;
    add_object(&document, name);
    const Autosaves autosaves(folder.path());
    write_work_file(autosaves.own(), *scene, document);
    return autosaves.own();
  };
  const auto first_left = left_after("mug"), then_left = left_after("lamp");
  std::filesystem::last_write_time(first_left,
                                   std::filesystem::last_write_time(then_left) - std::chrono::hours(1));
  Autosaves one(folder.path());
  const Autosaves two(folder.path());
  CHECK(one.own() != two.own());
  CHECK(one.left_behind() == std::vector{then_left, first_left});  // the newest first
  CHECK(two.left_behind().empty());                                // the other offers them
  one.remove(then_left);
  CHECK_FALSE(std::filesystem::exists(then_left));
  CHECK(one.left_behind() == std::vector{first_left});
  one.remove(first_left);
  CHECK(one.left_behind().empty());
}

TEST_CASE("work that was saved, changed and restored is saved to its file again") {
  const ScratchFolder folder("state_saved_as");
  const auto own = folder / "mine.splatcut.json";
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    app.studio().apply(SaveWork{own});
    REQUIRE(app.settle());
    app.studio().apply(RenameObject{app.studio().document().active, "red"});
    app.frames(60 * 3);
    REQUIRE(app.settle());
  }  // no leave(): as if it had crashed
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  REQUIRE(app.studio().work().offers().size() == 1);
  app.studio().apply(OpenScene{app.studio().work().offers().front().file});
  REQUIRE(app.settle());
  CHECK(app.studio().document().objects.front().name == "red");
  CHECK(app.studio().unsaved());
  CHECK(app.studio().work().work_path() == own);
  app.key('S', {.ctrl = true});
  app.frames(3);
  app.key(key::kEnter);
  REQUIRE(app.settle());
  CHECK_FALSE(app.studio().unsaved());
  CHECK(read_work_file(own).content->at("objects")[0].at("name") == "red");
  CHECK_FALSE(read_work_file(own).content->contains("saved_as"));
}

TEST_CASE("work that was saved by itself shows what the window showed: the object alone") {
  const ScratchFolder folder("state_alone");
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    app.frames(60 * 3);
    REQUIRE(app.settle());
    app.key('I');
    app.frames(60);
    REQUIRE(app.settle());
  }  // no leave(): as if it had crashed
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  opened(app);
  REQUIRE(app.studio().view().display == DisplayMode::kWhole);
  app.studio().apply(OpenScene{app.studio().work().offers().front().file});
  REQUIRE(app.settle());
  CHECK(app.studio().view().display == DisplayMode::kIsolate);
  app.key('I');
  CHECK(app.studio().view().display == DisplayMode::kWhole);
}

TEST_CASE("work that was not saved is offered where another scene was opened in its place") {
  const ScratchFolder folder("state_other");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_state(folder));
  opened(app);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const Document saved = app.studio().document();
  const auto open_anyway = [&](const std::filesystem::path& scene) {
    app.open(scene);
    app.frames(3);
    app.press_item("###open_anyway", {"Open"});
    REQUIRE(app.settle());
    app.frames(60);
    REQUIRE(app.settle());
  };
  open_anyway(kSmallSample);
  CHECK_FALSE(app.studio().unsaved());
  REQUIRE(app.studio().work().offers().size() == 1);
  const std::filesystem::path left = app.studio().work().offers().front().file;
  CHECK(left != app.studio().work().own_autosave());
  // It goes on from there, and the work in its place is kept in turn.
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  open_anyway(left);
  CHECK(same(app.studio().document(), saved));
  REQUIRE(app.studio().work().offers().size() == 1);
  CHECK(app.studio().work().offers().front().scene.filename() == kSmallSample.filename());
  // Each stays once where one is restored in place of another at once.
  for (int i = 0; i < 3; ++i) {
    app.studio().apply(OpenScene{app.studio().work().offers().front().file});
    REQUIRE(app.settle());
    REQUIRE(app.studio().work().offers().size() == 1);
    CHECK_FALSE(app.studio().work().offers().front().scene.empty());
  }
  // Once it is saved there is nothing to keep.
  app.studio().apply(SaveWork{folder / "work.splatcut.json"});
  REQUIRE(app.settle());
  app.open(kSample);
  REQUIRE(app.settle());
  CHECK(app.studio().work().offers().size() == 1);
}

TEST_CASE("work that another scene replaces is kept however much was left before") {
  const ScratchFolder folder("much_left");
  constexpr std::size_t kWorks = 120;
  Autosaves autosaves(folder.path());
  std::set<std::filesystem::path> left;
  for (std::size_t i = 0; i < kWorks; ++i) {
    REQUIRE_FALSE(autosaves.own().empty());
    left.insert(autosaves.own());
    std::ofstream(autosaves.own()) << "work " << i;
    autosaves.leave_own();
  }
  CHECK(left.size() == kWorks);
  CHECK(autosaves.left_behind().size() == kWorks);
  CHECK_FALSE(left.contains(autosaves.own()));
}
