// Work in files that are saved: read back the same and computed again, and what is wrong with a file.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/cli/work_cut.h"
#include "app/work/work_file.h"
#include "core/error.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("saved work: another chosen object or background is no unsaved work") {
  const ScratchFolder folder("chosen");
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  Studio& studio = app.studio();
  studio.apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  studio.apply(NewObject{});
  studio.apply(SaveWork{folder / "two.splatcut.json"});
  REQUIRE(app.settle());
  REQUIRE_FALSE(studio.unsaved());
  studio.apply(ActivateObject{studio.document().objects.front().id});
  CHECK_FALSE(studio.unsaved());
  studio.apply(SetBackground{{1, 1, 1}});
  CHECK_FALSE(studio.unsaved());
  studio.apply(RenameObject{studio.document().active, "mug"});
  CHECK(studio.unsaved());
  studio.apply(Undo{});
  CHECK_FALSE(studio.unsaved());
}

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

TEST_CASE(
    "saved work: every stroke keeps its size, and that of an object of older files is its first one's") {
  const ScratchFolder folder("sizes_of_work");
  const auto file = folder / "sizes.splatcut.json";
  const auto scene = open_scene(kSmallSample);
  Document document;
  ObjectItem& item = add_object(&document, "mug");
  const Camera camera = load_cameras(kSampleFolder / "cameras.json").front();
  Strokes strokes = {click({300, 200}, SeedLabel::kRest), click({310, 200}, SeedLabel::kObject),
                     click({320, 200}, SeedLabel::kRest)};
  strokes[1].size_step = 2;
  strokes[2].size_step = -1;
  item.views = {{camera, strokes}};
  write_work_file(file, *scene, document);
  const auto steps = [&] {
    std::vector<int> found;
    const RestoredWork read = restored(read_work_file(file), *scene);
    for (const Stroke& stroke : read.document.objects.front().views.front().strokes)
      found.push_back(stroke.size_step);
    return found;
  };
  CHECK(steps() == std::vector{0, 2, -1});
  nlohmann::json work = nlohmann::json::parse(std::ifstream(file));
  work["splatcut_work"] = 8;
  work["objects"][0]["part_step"] = -3;
  for (nlohmann::json& stroke : work["objects"][0]["views"][0]["strokes"]) stroke.erase("size_step");
  std::ofstream(file) << work;
  CHECK(steps() == std::vector{0, -3, 0});
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
                                        ", this splatcut reads versions 7 to 9") != std::string::npos);
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
