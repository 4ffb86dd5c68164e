// What can be undone and redone, in work files.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/document/words.h"
#include "app/work/work_file.h"
#include "app/work/work_history.h"
#include "core/error.h"
#include "opened_sample.h"
#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

std::vector<std::string> titles(const History& history) {
  std::vector<std::string> out;
  for (const History::Entry& entry : history.entries()) out.push_back(entry.title);
  return out;
}

// A history of objects named one after the other.
History of_names(const std::vector<std::string>& names) {
  History history;
  Document document;
  for (const std::string& name : names) {
    add_object(&document, name);
    history.push("New " + name, document);
  }
  return history;
}

}  // namespace

TEST_CASE("saved work: what was done before a crash can be undone after it, and what was undone redone") {
  const ScratchFolder folder("history_saved");
  ApplicationOptions options = with_state(folder);
  std::vector<std::string> steps;
  std::vector<Document> documents;
  std::vector<std::vector<std::uint8_t>> labels;
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    const ObjectId apple = app.studio().document().active;
    app.studio().apply(RenameObject{apple, "apple"});
    const Camera camera = app.studio().viewport().pane_camera();
    app.studio().apply(SelectRegion{
        camera, rectangle_region({0, 0}, {90, 90}, camera.width_px, camera.height_px), SetOperation::kAdd});
    REQUIRE(app.settle());
    app.studio().apply(SetSmoothness{apple, 3.5f});
    REQUIRE(app.settle());
    const History& history = app.studio().history();
    for (const History::Entry& entry : history.entries()) {
      documents.push_back(entry.document);
      labels.push_back(entry.document.objects.empty()
                           ? std::vector<std::uint8_t>()
                           : labels_of(entry.document, entry.document.objects.front(),
                                       app.studio().scene()->cloud->size()));
    }
    app.studio().apply(Undo{});
    REQUIRE(app.settle());
    app.frames(60 * 3);
    REQUIRE(app.settle());
    steps = titles(history);
    REQUIRE(steps.size() >= 5);  // opened, click, name, marks, smoothness
    REQUIRE(history.cursor() + 2 == steps.size());
  }  // no leave(): as if it had crashed
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, options);
  app.studio().apply(OpenScene{app.studio().work().offers().front().file});
  REQUIRE(app.settle());
  const History& history = app.studio().history();
  CHECK(titles(history) == steps);
  REQUIRE(history.cursor() + 2 == steps.size());
  const auto is_as_it_was = [&] {
    const std::size_t at = history.cursor();
    CAPTURE(at);
    REQUIRE(app.settle());
    CHECK(same(app.studio().document(), documents[at]));
    if (!documents[at].objects.empty()) CHECK(active_labels(app) == labels[at]);
  };
  is_as_it_was();
  while (history.can_undo()) {
    app.studio().apply(Undo{});
    is_as_it_was();
  }
  while (history.can_redo()) {
    app.studio().apply(Redo{});
    is_as_it_was();
  }
}

TEST_CASE("saved work: what is locked keeps its labels under an undo by another method, restored, too") {
  const ScratchFolder folder("locked_saved");
  const auto file = folder / "locked.splatcut.json";
  Hands hands;
  Studio& studio = hands.studio();
  const ObjectId apple = studio.document().active;
  studio.apply(LockObject{apple, true});
  const std::vector<std::uint8_t> before = active_labels(hands.app);
  REQUIRE(count_flags(before) > 0);
  studio.apply(SetPreset{"paper"});
  studio.apply(RenameObject{apple, "apple"});
  studio.apply(SaveWork{file});
  REQUIRE(hands.app.settle());
  studio.apply(OpenScene{file});
  REQUIRE(hands.app.settle());
  studio.apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK(studio.document().preset == "paper");
  CHECK(active_labels(hands.app) == before);
}

TEST_CASE("saved work: steps before and after changes of the scene's files, two hundred at most") {
  History history = of_names({"a", "b", "c"});
  SavedSteps saved = saved_steps(history);
  CHECK(saved.steps.size() == 4);
  CHECK(saved.cursor == 3);
  history.push_other_files("Adding", 1);
  Document more = history.now();
  add_object(&more, "d");
  history.push("New d", more);
  history.jump(2);  // past the step to other files, which was not undone
  saved = saved_steps(history);
  REQUIRE(saved.steps.size() == 6);
  CHECK(saved.cursor == 2);
  for (std::size_t i = 0; i < saved.steps.size(); ++i) CHECK(saved.steps[i].other_files == (i == 4));
  History read;
  read.reset(saved);
  CHECK(read.entries()[4].other_files == History::kNotKept);
  CHECK(read.entries()[5].other_files == 0);
  saved.steps.erase(saved.steps.begin(), saved.steps.begin() + 4);  // as where older steps do not fit
  saved.cursor = 0;
  read.reset(saved);
  CHECK(read.entries()[0].other_files == 0);

  History long_one;
  for (int i = 0; i < 500; ++i) {
    Document next = long_one.now();
    next.background.r = static_cast<float>(i + 1) / 1000;
    long_one.push("Background", next);
  }
  CHECK(saved_steps(long_one).cursor == kMostSavedSteps / 2);
  long_one.jump(300);
  CHECK(saved_steps(long_one).steps.size() == kMostSavedSteps);
  CHECK(saved_steps(long_one).steps[saved_steps(long_one).cursor].document.background.r ==
        doctest::Approx(0.3f));
}

TEST_CASE("saved work: steps from before changes of the scene's files can be undone, the changes stay") {
  const ScratchFolder folder("history_of_files");
  const auto file = folder / "two.splatcut.json";
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = active_by_row(studio);
  studio.apply(RenameObject{studio.document().active, "apple"});
  add(hands, small_scene(folder));
  studio.apply(NewObject{});
  studio.apply(SelectScene{last_file(hands).id});
  REQUIRE(hands.selected() == kAdded);
  studio.apply(PlaceScene{last_file(hands).id, {{1, 2, 3}}});
  REQUIRE(hands.app.settle());
  studio.apply(EditSelection{SelectionEdit::kNone});
  studio.apply(SaveWork{file});
  REQUIRE(hands.app.settle());
  const std::vector<std::string> steps = titles(studio.history());
  REQUIRE(steps.size() == 8);  // opened, click, name, added, object, selected, placed, none

  Hands again(false, with_kept_scenes(), file);
  Studio& restored = again.studio();
  REQUIRE(titles(restored.history()) == steps);
  CHECK(restored.history().cursor() == 7);
  for (const History::Entry& step : restored.history().entries())
    CHECK(restored.files().stays(step) == (step.title == steps[3] || step.title == steps[6]));
  const auto undo = [&] {
    restored.apply(Undo{});
    REQUIRE(again.app.settle());
    return again.said();
  };
  CHECK(undo().starts_with("Undone: "));
  CHECK(again.selected() == kAdded);
  CHECK(undo() == "Not undone: " + steps[6] + ". The scene before it is no longer kept");
  CHECK(last_file(again).place.move.x == 1);
  CHECK(again.selected() == kAdded);
  undo();
  CHECK(again.selected() == 0);
  undo();
  CHECK(undo().starts_with("Not undone: "));
  CHECK(restored.scene()->files.size() == 2);
  CHECK(active_by_row(restored) == longer(apple, kAdded));
  CHECK(undo().starts_with("Undone: "));
  CHECK(restored.document().objects.front().name != "apple");
  CHECK(undo().starts_with("Undone: "));
  CHECK(restored.document().objects.empty());
  CHECK_FALSE(restored.why_not(Action::kUndo).empty());
  while (restored.history().can_redo()) restored.apply(Redo{});
  REQUIRE(again.app.settle());
  CHECK(restored.document().objects.size() == 2);
  add(again, small_scene(folder, "other.ply", 2));  // a change of files of now is undone as ever
  CHECK(restored.scene()->files.size() == 3);
  CHECK(undo().starts_with("Undone: "));
  CHECK(restored.scene()->files.size() == 2);
}

TEST_CASE("saved work: what steps share stands in the file once") {
  const ScratchFolder folder("history_shared");
  const auto file = folder / "work.splatcut.json";
  const auto scene = open_scene(kSample);
  Document document;
  add_object(&document, "mug").hand =
      make_flags(std::vector<std::uint8_t>(scene->cloud->size(), kHandObject));
  History history;
  history.push("Marks", document);
  for (int i = 0; i < 20; ++i) {
    document.background.r = static_cast<float>(i + 1) / 50;
    history.push("Background", document);
  }
  document.objects.front().hand = make_flags(std::vector<std::uint8_t>(scene->cloud->size(), kHandRest));
  history.push("Marks", document);
  write_work_file(file, *scene, document, {}, saved_steps(history));
  const nlohmann::json written = nlohmann::json::parse(std::ifstream(file));
  CHECK(written["history"]["arrays"].size() == 2);
  CHECK(written["history"]["objects"].size() == 2);
  CHECK(written["history"]["steps"].size() == 23);
  const RestoredWork read = restored(read_work_file(file), *scene);
  CHECK(read.warning.empty());
  REQUIRE(read.history.steps.size() == 23);
  for (std::size_t i = 0; i < 23; ++i)
    CHECK(same(read.history.steps[i].document, history.entries()[i].document));
}

TEST_CASE("saved work: steps that cannot be read are left out, and that is said") {
  const ScratchFolder folder("history_damaged");
  const auto file = folder / "work.splatcut.json";
  const auto scene = open_scene(kSample);
  const History history = of_names({"a", "b"});
  write_work_file(file, *scene, history.now(), {}, saved_steps(history));
  const nlohmann::json right = nlohmann::json::parse(std::ifstream(file));
  REQUIRE(restored(read_work_file(file), *scene).history.steps.size() == 3);
  const auto is_left_out = [&](const char* where, const nlohmann::json& what) {
    CAPTURE(where);
    nlohmann::json work = right;
    work["history"][nlohmann::json::json_pointer(where)] = what;
    std::ofstream(file) << work;
    const RestoredWork read = restored(read_work_file(file), *scene);
    CHECK(read.history.steps.empty());
    CHECK(read.warning.starts_with("the steps before it cannot be undone ("));
    CHECK(same(read.document, history.now()));
  };
  is_left_out("/cursor", 3);
  is_left_out("/cursor", -1);
  is_left_out("/cursor", "last");
  is_left_out("/steps/0/deleted", 0);  // no such array
  is_left_out("/steps/1/objects", {7});
  is_left_out("/steps/1/objects", {0, 0});
  is_left_out("/steps/1/up", {0, 0, 0});
  is_left_out("/steps/1/preset", "none of these");
  is_left_out("/steps/1/other_files", "yes");
  is_left_out("/objects/0/name", 3);
  is_left_out("/steps", nlohmann::json(std::vector<int>(100'000, 0)));
  is_left_out("/arrays", std::vector<nlohmann::json>(10'000, {0, 1}));
  nlohmann::json three = right;  // hand marks are three values, labels two
  three["history"]["arrays"] = {{2, scene->scene->file_rows}};
  three["history"]["steps"][0]["deleted"] = 0;
  std::ofstream(file) << three;
  CHECK(restored(read_work_file(file), *scene).warning.find("array 0 holds more than 1") !=
        std::string::npos);
  nlohmann::json none = right;
  none.erase("history");  // as older programs wrote it
  std::ofstream(file) << none;
  CHECK(restored(read_work_file(file), *scene).warning.empty());
}

TEST_CASE(
    "saved work: an undo right after it is restored says what the undo took away, not what a click did") {
  const ScratchFolder folder("history_undo_said");
  {
    HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_kept_scenes());
    opened(app);
    for (const glm::vec2& at : {kOnApple, kOnOrange, kOnMug, glm::vec2(360, 300)}) {
      app.click(app.screen_of(at), PointerButton::kLeft, {.shift = true});
      REQUIRE(app.settle());
    }
    app.studio().apply(SaveWork{folder / "work.splatcut.json"});
    REQUIRE(app.settle());
  }
  HeadlessApp app(kSmallWidth, kSmallHeight, 1, with_kept_scenes());
  app.open(folder / "work.splatcut.json");
  REQUIRE(app.settle());
  const auto undone = [&] {
    const std::vector<std::uint8_t> before = active_labels(app);
    app.studio().apply(Undo{});
    REQUIRE(app.settle());
    const std::vector<std::uint8_t> after = active_labels(app);
    std::size_t added = 0, removed = 0;
    for (std::size_t g = 0; g < after.size(); ++g) {
      added += after[g] && !before[g];
      removed += before[g] && !after[g];
    }
    REQUIRE(added + removed > 0);
    return fmt::format(", {} added and {} removed", grouped(added), grouped(removed));
  };
  // The step next to it needs no cut.
  undone();
  CHECK(app.studio().messages().back().text.starts_with("Undone: "));
  for (int i = 0; i < 2; ++i) {
    const std::string expected = undone(), said = app.studio().messages().back().text;
    CAPTURE(said);
    CAPTURE(expected);
    CHECK(said.find(expected) != std::string::npos);
  }
  // What is not known is no difference: three undone at once.
  app.open(folder / "work.splatcut.json");
  app.frames(3);
  if (app->interface().dialog_open()) app.press_item("###open_anyway", {"Open"});
  REQUIRE(app.settle());
  for (int i = 0; i < 3; ++i) app.studio().apply(Undo{});
  REQUIRE(app.settle());
  CHECK(app.studio().messages().back().text.find(" cut out in ") != std::string::npos);
}

TEST_CASE("saved work: the labels before and after the present step are kept, and found at once") {
  const ScratchFolder folder("history_next");
  const auto file = folder / "work.splatcut.json";
  std::vector<std::vector<std::uint8_t>> labels;
  {
    Hands hands;
    labels.push_back(active_labels(hands.app));
    for (const glm::vec2& at : {kOnOrange, kOnMug}) {
      hands.app.click(hands.app.screen_of(at), PointerButton::kLeft, {.shift = true});
      REQUIRE(hands.app.settle());
      labels.push_back(active_labels(hands.app));
    }
    hands.studio().apply(Undo{});
    REQUIRE(hands.app.settle());
    hands.studio().apply(SaveWork{file});
    REQUIRE(hands.app.settle());
  }
  Hands hands(false, with_kept_scenes(), file);
  Studio& studio = hands.studio();
  const std::size_t cut = studio.cuts().done();
  const auto is_there = [&](std::size_t step) {
    CAPTURE(step);
    CHECK_FALSE(is_stale(studio.document(), *studio.document().active_object()));
    CHECK(active_labels(hands.app) == labels[step]);
  };
  is_there(1);
  studio.apply(Undo{});
  is_there(0);
  studio.apply(Redo{});
  studio.apply(Redo{});
  is_there(2);
  REQUIRE(hands.app.settle());
  CHECK(studio.cuts().done() == cut);
  // Not twice, also where it is what the present step has: what the thumbnails compare with is there alone.
  studio.apply(RenameObject{studio.document().active, "apple"});
  studio.apply(SaveWork{file});
  REQUIRE(hands.app.settle());
  const nlohmann::json written = nlohmann::json::parse(std::ifstream(file));
  std::size_t cuts = 0;
  for (const nlohmann::json& object : written["history"]["objects"]) cuts += !object["cut"].is_null();
  CHECK(cuts == 1);
}

TEST_CASE("saved work: labels kept for the next undo take no room from steps made by hand") {
  const auto rows_with_room_for = [](std::size_t arrays) { return (std::size_t{64} << 20) / arrays; };
  Scene scene;
  scene.cloud.resize(4, 0);
  scene.cloud.file_row = {0, 1, 2, 3};
  unsigned number = 0;
  const auto flags = [&] {  // no two alike
    ++number;
    return make_flags(
        {number & 1 ? std::uint8_t{1} : std::uint8_t{0}, number & 2 ? std::uint8_t{1} : std::uint8_t{0},
         number & 4 ? std::uint8_t{1} : std::uint8_t{0}, number & 8 ? std::uint8_t{1} : std::uint8_t{0}});
  };
  constexpr std::size_t kHands = 6;
  History history;
  Document document;
  add_object(&document, "mug").hand = flags();
  history.push("Hand", document);
  for (std::size_t i = 1; i < kHands; ++i) {
    document.objects.front().hand = flags();
    history.push("Hand", document);
  }
  const auto cut_in = [&](const char* title) {
    ObjectItem& object = document.objects.front();
    object.views = {{{}, {click({static_cast<float>(history.cursor()), 1}, SeedLabel::kObject)}, {}}};
    object.cut_key = cut_key(document, object);
    object.cut = flags();
    history.push(title, document);
  };
  for (const char* title : {"Click", "Click again", "Click once more"}) cut_in(title);
  history.undo();
  REQUIRE(history.entries().size() == kHands + 4);
  for (const std::size_t spare : {0, 1, 2}) {
    CAPTURE(spare);
    scene.file_rows = rows_with_room_for(kHands + spare);
    const nlohmann::json written = history_json(saved_steps(history), scene);
    CHECK(written["steps"].size() == history.entries().size());
    CHECK(written["arrays"].size() == kHands + spare);
  }
}
