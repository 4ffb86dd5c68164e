// Work in files: saved and read back, saved by itself, asked for before it goes.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/cli/work_cut.h"
#include "app/work/work_file.h"
#include "app/work/work_picture.h"
#include "core/error.h"
#include "core/png_file.h"
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

// Options of a program that keeps its work in the folder by itself.
ApplicationOptions kept_in(const ScratchFolder& folder) {
  ApplicationOptions options = with_kept_scenes();
  options.studio.state_folder = folder.path();
  return options;
}

}  // namespace

TEST_CASE("saved work: read back the same, and computed again bit for bit") {
  const ScratchFolder folder("work");
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, {});  // prepared anew
  opened(app);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  app.key('=', {.ctrl = true});
  app.studio().apply(SetSmoothness{app.studio().document().active, 3.5f});
  REQUIRE(app.settle());
  const auto file = folder / "apple.splatcut.json";
  app.studio().apply(SaveWork{file});
  REQUIRE(app.settle());
  REQUIRE(std::filesystem::exists(file));
  CHECK_FALSE(app.studio().unsaved());
  const auto labels = active_labels(app);
  const Document saved = app.studio().document();

  const auto scene = open_scene(read_work_file(file).files);
  const Document read = restored(read_work_file(file), *scene).document;
  CHECK(same(read, saved));
  Document empty = read;
  for (ObjectItem& object : empty.objects) object.cut = nullptr;
  const Document again = computed_again(*scene, empty);
  CHECK(labels_of(again, *again.active_object(), labels.size()) == labels);
  CHECK(same(again, saved));

  app.open(file);  // and the window opens it, with what is known of the cut
  REQUIRE(app.settle());
  CHECK(same(app.studio().document(), saved));
  const CutRun* run = app.studio().cuts().run(saved.active);
  REQUIRE(run);
  CHECK(run->views.size() > 2);
  CHECK(run->meanings);
  CHECK(app.studio().why_not(Action::kPartLarger).empty());

  nlohmann::json of_another = nlohmann::json::parse(std::ifstream(file));
  nlohmann::json& cut = of_another["objects"][0]["cut"];
  cut[0] = 1 - cut[0].get<int>();  // labels that this program would not make
  cut[2] = cut[0];
  std::ofstream(file) << of_another;
  app.open(file);
  REQUIRE(app.settle());
  CHECK(app.studio().labels(saved.active) ==
        labels_of(restored(read_work_file(file), *scene).document,
                  *restored(read_work_file(file), *scene).document.active_object(), labels.size()));
  CHECK(app.studio().labels(saved.active) != labels);
  run = app.studio().cuts().run(saved.active);
  REQUIRE(run);
  CHECK(run->views.empty());  // what it would show is another cut
}

TEST_CASE("saved work: what is wrong with a file is said in one sentence") {
  const ScratchFolder folder("wrong_work");
  const auto file = folder / "wrong.splatcut.json";
  const auto scene = open_scene(kSample);
  Document document;
  add_object(&document, "mug");
  write_work_file(file, *scene, document);
  const nlohmann::json right = nlohmann::json::parse(std::ifstream(file));
  const auto said_of = [&](const nlohmann::json& work) -> std::string {
    std::ofstream(file) << work;
    try {
      restored(read_work_file(file), *scene);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  CHECK(said_of(right).empty());
  nlohmann::json no_up = right;
  no_up["up"] = {0, 0, 0};
  CHECK(said_of(no_up) == file.string() + ": up: is no direction.");
  nlohmann::json no_view = right;
  no_view["view"] = {
      {"camera_from_world", {0, 0, 0, 0}}, {"position", {0, 0, 0}}, {"distance", 1}, {"fov_y_rad", 1}};
  CHECK(said_of(no_view) == file.string() + ": view: is no place to look from.");
  const auto said_of_version = [&](const nlohmann::json& version) {
    nlohmann::json work = right;
    work["splatcut_work"] = version;
    return said_of(work);
  };
  for (const nlohmann::json& version : {nlohmann::json(0), nlohmann::json(-2), nlohmann::json(6),
                                        nlohmann::json(1000), nlohmann::json("5"), nlohmann::json(5.5)})
    CHECK(said_of_version(version).find("is of version " + version.dump() +
                                        ", this splatcut reads versions 7 to 8") != std::string::npos);
}

TEST_CASE(
    "saved work: a method that this program does not know gives way to the default one, and that is said") {
  const ScratchFolder folder("old_method");
  const auto file = folder / "old.splatcut.json";
  const auto scene = open_scene(kSample);
  Document document;
  add_object(&document, "mug");
  write_work_file(file, *scene, document);
  nlohmann::json work = nlohmann::json::parse(std::ifstream(file));
  CHECK(restored(read_work_file(file), *scene).warning.empty());
  work["preset"] = "fast";
  std::ofstream(file) << work;
  const RestoredWork read = restored(read_work_file(file), *scene);
  CHECK(read.document.preset == "default");
  CHECK(read.warning ==
        "its method, \"fast\", is not known to this program: what is computed from now on is computed by "
        "\"default\"");
}

TEST_CASE("a view left out is that view: after a save, and after another preset was tried") {
  const ScratchFolder folder("left_out");
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  app.studio().apply(SetPreset{"paper"});
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const ObjectId id = app.studio().document().active;
  const auto views = [&] { return app.studio().cuts().run(id)->views; };
  REQUIRE(views().size() > 2);
  const Camera camera = views()[2].camera;
  app.studio().apply(LeaveOutView{id, camera, true});
  REQUIRE(app.settle());
  const auto counts = [&](const Camera& c) {
    for (const ViewCard& card : views())
      if (same_view(card.camera, c)) return card.used ? "used" : "left out";
    return "not looked at";
  };
  CHECK(counts(camera) == std::string("left out"));
  const auto labels = active_labels(app);
  app.studio().apply(SetPreset{"default"});
  REQUIRE(app.settle());
  CHECK(std::ranges::count_if(views(), &ViewCard::used) == 1);
  app.studio().apply(SetPreset{"paper"});
  REQUIRE(app.settle());
  CHECK(counts(camera) == std::string("left out"));
  CHECK(active_labels(app) == labels);
  const auto file = folder / "apple.splatcut.json";
  app.studio().apply(SaveWork{file});
  REQUIRE(app.settle());
  const auto scene = open_scene(read_work_file(file).files);
  const RestoredWork read = restored(read_work_file(file), *scene);
  CHECK(read.warning.empty());
  CHECK(same(read.document, app.studio().document()));
}

TEST_CASE("work is saved by itself and offered after a crash") {
  const ScratchFolder folder("state");
  Document saved;
  CameraPose pose;
  {
    ApplicationOptions options = with_kept_scenes();
    options.studio.state_folder = folder.path();
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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
  CHECK(app.studio().work().offers().empty());
  CHECK(app.studio().unsaved());  // it is nowhere else yet
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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
  ApplicationOptions options = with_kept_scenes();
  options.studio.state_folder = folder.path();
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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

TEST_CASE("work that is saved by itself has a small picture of the view, which goes with it") {
  const ScratchFolder folder("state_picture");
  ApplicationOptions options = with_kept_scenes();
  options.studio.state_folder = folder.path();
  const auto picture = folder / "autosave.png";
  Image<Rgb8> shown;
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    // What was saved meanwhile may have the picture before, or what the next click would change.
    app.move({2, 2});
    REQUIRE(app.settle());
    app.studio().apply(RenameObject{app.studio().document().active, "apple"});
    app.frames(60 * 3);
    REQUIRE(app.settle());
    shown = work_picture(app.studio().viewport().picture()->pictures.front());
  }  // no leave(): as if it had crashed
  CHECK(std::filesystem::file_size(picture) < 30'000);
  CHECK(read_png_rgb(picture) == shown);
  CHECK(shown.width() == kWorkPictureWidthPx);
  CHECK(std::ranges::adjacent_find(shown.pixels(), std::not_equal_to<>()) != shown.pixels().end());
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    REQUIRE(app.studio().work().offers().size() == 1);
    const Image<Rgba8>& offered = app.studio().work().offers().front().picture;
    REQUIRE(offered.width() == shown.width());
    CHECK(offered.at(40, 20) == Rgba8{shown.at(40, 20)[0], shown.at(40, 20)[1], shown.at(40, 20)[2], 255});
    opened(app);
    app.click(app.screen_of(kOnOrange));
    REQUIRE(app.settle());
    app.frames(60 * 3);
    REQUIRE(app.settle());
    CHECK(std::filesystem::exists(folder / "autosave.2.png"));
    app.studio().apply(DropAutosave{app.studio().work().offers().front().file});
    CHECK_FALSE(std::filesystem::exists(picture));
    app.studio().apply(Undo{});
    REQUIRE(app.settle());
    REQUIRE(app.studio().document().objects.empty());
    app.studio().leave();  // nothing is unsaved
  }
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.2.splatcut.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.2.png"));
}

TEST_CASE("a picture of left work that is damaged, huge, no picture or not there hinders nothing") {
  const ScratchFolder folder("state_damaged_picture");
  const auto scene = open_scene(kSmallSample);
  Document document;
  add_object(&document, "mug");
  const auto work = folder / "autosave.splatcut.json", picture = folder / "autosave.png";
  write_work_file(work, *scene, document);
  ApplicationOptions options = with_kept_scenes();
  options.studio.state_folder = folder.path();
  const Rgb8 magenta{255, 0, 255};
  const std::string whole = png_bytes(Image<Rgb8>(kWorkPictureWidthPx, 60, magenta));
  // What the list of the start page shows of the picture, in pixels.
  const auto pixels_shown = [&] {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    app.frames(3);
    CHECK(app.button("small_sample.compressed.ply").size().x > 100);
    CHECK(app.button("small_sample.compressed.ply").size().y > 40);
    return std::ranges::count(app.picture().pixels(), magenta);
  };
  const auto put = [&](const std::string& bytes) { std::ofstream(picture, std::ios::binary) << bytes; };
  CHECK(pixels_shown() == 0);
  put(whole);
  CHECK(pixels_shown() > 2500);
  for (const std::size_t bytes : {0, 1, 20, 40, 70}) {
    put(whole.substr(0, bytes));
    CHECK(pixels_shown() == 0);
  }
  put("no picture at all, but some text");
  CHECK(pixels_shown() == 0);
  put(png_bytes(Image<Rgb8>(3000, 3000, magenta)));
  CHECK(pixels_shown() == 0);
  std::filesystem::remove(picture);
  std::filesystem::create_directories(picture / "in it");
  CHECK(pixels_shown() == 0);
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
  app.studio().apply(OpenScene{work});
  REQUIRE(app.settle());
  CHECK(app.studio().document().objects.size() == 1);
  app.frames(60 * 3);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "autosave.2.splatcut.json"));
  CHECK_FALSE(std::filesystem::exists(work));
}

TEST_CASE("the small picture of a view of any size and shape is 96 pixels wide at most") {
  CHECK(work_picture({}).empty());
  const auto size = [](int width, int height) {
    const Image<Rgb8> small = work_picture(Image<Rgba8>(width, height, {1, 2, 3, 255}));
    CHECK(std::ranges::all_of(small.pixels(), [](const Rgb8& c) { return c == Rgb8{1, 2, 3}; }));
    return std::pair(small.width(), small.height());
  };
  CHECK(size(960, 600) == std::pair(96, 60));
  CHECK(size(1, 1) == std::pair(1, 1));
  CHECK(size(5000, 1) == std::pair(96, 1));
  CHECK(size(3, 5000) == std::pair(3, 192));
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, kept_in(folder));
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

TEST_CASE("objects: one byte per Gaussian names 255 of them, the 256th is refused with a sentence") {
  const ScratchFolder folder("objects");
  Document document;
  for (std::size_t i = 0; i < kMostObjects; ++i) add_object(&document);
  CHECK_THROWS_WITH_AS(add_object(&document),
                       "There are 255 objects already, more cannot be shown. Merge or remove some.", Error);
  CHECK(document.objects.size() == kMostObjects);
  CHECK(document.next_id == kMostObjects + 1);

  const auto scene = open_scene(kSample);
  const auto file = folder / "many.splatcut.json";
  write_work_file(file, *scene, document);
  CHECK(restored(read_work_file(file), *scene).document.objects.size() == kMostObjects);
  ObjectItem another = document.objects.back();
  another.id = document.next_id++;
  document.objects.push_back(another);
  write_work_file(file, *scene, document);
  CHECK_THROWS_AS(restored(read_work_file(file), *scene), Error);
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
