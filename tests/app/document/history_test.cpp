// The history, the labels kept for it, and the edits that are made one after the other, by themselves.
#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

#include "app/document/label_cache.h"
#include "app/studio/studio.h"
#include "core/error.h"
#include "headless_app.h"
#include "random_scene.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr std::size_t kFewGaussians = 50;

Camera small_camera() {
  return look_at({0, 0, -3}, {0, 0, 0}, {0, -1, 0}, 1, 64, 48);
}

Flags random_flags(std::mt19937& random, int values) {
  std::vector<std::uint8_t> flags(kFewGaussians);
  for (std::uint8_t& flag : flags) flag = static_cast<std::uint8_t>(random() % static_cast<unsigned>(values));
  return make_flags(std::move(flags));
}

Document with_click(Document document, const glm::vec2& pixel) {
  if (!document.active_object()) add_object(&document);
  document.find(document.active)
      ->views.push_back({small_camera(), {click(pixel, SeedLabel::kObject)}, nullptr});
  return document;
}

}  // namespace

TEST_CASE("history: the state before the last stroke, whatever size that has, and none after other edits") {
  History history;
  const auto before = [&](ObjectId object = 1) { return before_last_stroke(history, object); };
  const auto state = [&](std::size_t entry) { return &history.entries()[entry].document; };
  const auto push = [&](const char* title, const Document& document) {
    history.push(title, document);
    history.set_cut(1, history.keys(*history.now().find(1)).cut, make_flags({1, 0}));
  };
  const auto with_size = [&](int step) {
    Document document = history.now();
    last_stroke(&document.find(1)->views)->size_step = step;
    return document;
  };
  CHECK(before() == nullptr);
  push("Click: object", with_click({}, {30, 20}));  // 1
  CHECK(before() == nullptr);
  push("Larger part", with_size(1));  // 2
  push("Larger part", with_size(2));  // 3
  CHECK(before() == state(1));        // in its own size
  push("Smaller part", with_size(0));
  CHECK(before() == state(1));
  push("Click: object", with_click(history.now(), {20, 20}));  // 5
  CHECK(before() == state(4));
  push("Smaller part", with_size(-1));
  push("Smaller part", with_size(-2));
  CHECK(before() == state(4));
  Document document = history.now();
  document.find(1)->tinted = false;
  push("Hide", document);  // 8
  CHECK(before() == state(4));
  document.find(1)->smoothness = 0.5f;
  push("Smoothness", document);  // 9
  CHECK(before() == nullptr);
  history.undo();
  CHECK(before() == state(4));
  document = history.now();
  document.find(1)->hand = make_flags({1, 1});
  push("Add", document);  // 9
  CHECK(before() == nullptr);
  push("Larger part", with_size(-1));  // 10
  CHECK(before() == state(9));         // what the hand did is none of it
  push("Click: object", with_click(history.now(), {10, 20}));
  CHECK(before() == state(10));
  document = history.now();
  document.deleted = make_flags({0, 1});
  push("Delete", document);
  CHECK(before() == nullptr);
  history.jump(2);
  CHECK(before() == state(1));
  document = history.now();
  document.find(1)->choice = 1;
  push("Other meaning", document);  // 3
  CHECK(before() == nullptr);
  CHECK(before(7) == nullptr);
}

TEST_CASE("history: before a stroke stands what was shown, also where a cut was never made") {
  History history;
  history.push("Click: object", with_click({}, {30, 20}));
  history.push("Click: object", with_click(history.now(), {20, 20}));
  CHECK(before_last_stroke(history, 1) == nullptr);  // nothing was shown before
  history.set_cut(1, history.keys(*history.now().find(1)).cut, make_flags({1, 0}));
  history.push("Click: rest", with_click(history.now(), {10, 20}));
  history.push("Click: rest", with_click(history.now(), {12, 20}));
  CHECK(before_last_stroke(history, 1) == &history.entries()[3].document);
}

TEST_CASE("history: no state before a stroke is one of other settings, or of labels that are not known") {
  History history;
  const auto cut = [&] { history.set_cut(1, history.keys(*history.now().find(1)).cut, make_flags({1, 0})); };
  history.push("Click: object", with_click({}, {30, 20}));
  cut();
  Document document = history.now();
  document.find(1)->hand = make_flags({kFollowCut, kHandObject});
  history.push("Lasso", document);
  history.push("Click: object", with_click(history.now(), {20, 20}));
  cut();
  CHECK(before_last_stroke(history, 1) == &history.entries()[2].document);
  SUBCASE("by the wheel after the smoothness") {
    document = history.now();
    document.find(1)->smoothness = 0.5f;
    history.push("Smoothness", document);
    last_stroke(&document.find(1)->views)->size_step = 1;
    history.push("Larger part", document);
    cut();
    CHECK(before_last_stroke(history, 1) != &history.entries()[2].document);
  }
  SUBCASE("opened again, without the cuts of steps but with what hands did") {
    History opened;
    for (std::size_t e = 1; e < history.entries().size(); ++e) {
      document = history.entries()[e].document;
      document.find(1)->cut = nullptr;
      document.find(1)->cut_key.clear();
      opened.push("step", document);
    }
    opened.set_cut(1, opened.keys(*opened.now().find(1)).cut, make_flags({1, 0}));
    CHECK(before_last_stroke(opened, 1) == nullptr);
  }
}

TEST_CASE("history: rows of the list that are called alike say which object and which stroke") {
  History history;
  Document document = with_click({}, {30, 20});
  history.push("Click: object", document);
  history.push("Click: object", document = with_click(document, {20, 20}));
  add_object(&document, "Mug");
  history.push("New object", document);
  history.push("Click: object", document = with_click(document, {10, 20}));
  history.push("Click: rest", document = with_click(document, {12, 20}));
  document.find(document.active)->tinted = false;
  history.push("Hide", document);
  document.find(1)->colour = {1, 2, 3};
  history.push("Colour", document);
  history.push_other_files("a.ply moved", 1);
  std::erase_if(document.objects, [](const ObjectItem& o) { return o.id == 1; });
  history.push("Remove object", document);
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < history.entries().size(); ++i) rows.push_back(row_title(history, i));
  CHECK(rows == std::vector<std::string>{
                    "Open", "Click: object  (Object 1)", "Click: object  (Object 1, stroke 2)",
                    "New object  (Mug)", "Click: object  (Mug)", "Click: rest  (Mug, stroke 2)",
                    "Hide  (Mug)", "Colour  (Object 1)", "a.ply moved", "Remove object  (Object 1)"});
}

TEST_CASE("history: a step that changes nothing is none, every other counts once") {
  History history;
  const std::uint64_t start = history.serial();
  CHECK_FALSE(history.push("nothing", history.now()));
  CHECK(history.serial() == start);
  CHECK(history.push("click", with_click(history.now(), {3, 4})));
  CHECK(history.serial() != start);
  // Zeros are what no marks are.
  Document marked = history.now();
  marked.objects.front().hand = make_flags(std::vector<std::uint8_t>(kFewGaussians, 0));
  CHECK_FALSE(history.push("zeros", marked));
  CHECK(history.entries().size() == 2);
  history.undo();
  CHECK(history.now().objects.empty());
  history.redo();
  CHECK(history.now().objects.size() == 1);
}

TEST_CASE("history: steps with one key become one until something else is done") {
  History history;
  history.push("click", with_click(history.now(), {3, 4}));
  const auto smooth = [&](float value) {
    Document after = history.now();
    after.objects.front().smoothness = value;
    history.push("smoothness", after, "smoothness");
  };
  smooth(1);
  smooth(2);
  CHECK(history.entries().size() == 3);
  CHECK(history.merges("smoothness"));
  history.undo();
  CHECK_FALSE(history.now().objects.front().smoothness);
  CHECK_FALSE(history.merges("smoothness"));
  history.redo();
  smooth(3);
  CHECK(history.entries().size() == 4);
}

TEST_CASE("history: another background ends no drag, another object does") {
  History history;
  history.push("click", with_click(history.now(), {3, 4}));
  Document after = history.now();
  add_object(&after);
  history.push("sphere", after, "sphere");
  history.change_all([](Document* state) { state->background = {1, 0, 0}; });
  CHECK(history.merges("sphere"));
  history.change_all([](Document* state) { state->active = 1; });
  CHECK_FALSE(history.merges("sphere"));
}

TEST_CASE("objects: what is separated keeps its own parts and all wholes that it is a part of") {
  const GaussianCloud cloud = random_cloud(4, 1, 0);
  const EditContext context{cloud};
  Document document;
  for (const std::vector<std::uint8_t>& labels :
       {std::vector<std::uint8_t>{1, 1, 1, 0}, {1, 1, 0, 0}, {1, 0, 0, 0}, {1, 1, 1, 1}})
    set_labels(&document, &add_object(&document), labels);
  document.objects[1].within = document.objects[0].id;
  document.objects[2].within = document.objects[1].id;
  for (const std::size_t separated : {0u, 1u, 2u}) {
    CAPTURE(separated);
    Document then = document;
    edit(&then, SeparateObject{document.objects[separated].id}, context);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(labels_of(then, then.objects[i], 4) == labels_of(document, document.objects[i], 4));
    CHECK(count_flags(labels_of(then, then.objects[3], 4)) == separated + 1);
  }
}

TEST_CASE("objects: a part of an object that does not exist is refused") {
  const GaussianCloud cloud = random_cloud(kFewGaussians, 1, 0);
  const EditContext context{cloud};
  Document document;
  edit(&document, NewObject{}, context);
  edit(&document, NewObject{1}, context);
  CHECK(document.find(2)->within == 1);
  CHECK_THROWS_AS(edit(&document, NewObject{document.next_id}, context), Error);  // would be a part of itself
  CHECK(document.objects.size() == 2);
}

TEST_CASE("objects: a part stays what it is when its whole is removed or merged, locked or not") {
  const GaussianCloud cloud = random_cloud(kFewGaussians, 1, 0);
  const EditContext context{cloud};
  std::mt19937 random(3);
  for (const bool merged : {false, true})
    for (const bool locked : {false, true}) {
      Document document;
      edit(&document, NewObject{}, context);
      edit(&document, NewObject{1}, context);
      for (ObjectItem& object : document.objects) object.cut = random_flags(random, 2);
      edit(&document, LockObject{2, locked}, context);
      edit(&document, NewObject{}, context);
      const std::vector<std::uint8_t> before = labels_of(document, *document.find(2), kFewGaussians);
      REQUIRE(before != *document.find(2)->cut);
      if (merged)
        edit(&document, MergeObjects{3, 1}, context);
      else
        edit(&document, RemoveObject{1}, context);
      CHECK_FALSE(document.find(1));
      CHECK(labels_of(document, *document.find(2), kFewGaussians) == before);
    }
}

TEST_CASE("objects: smoothness goes back to the method's own") {
  const GaussianCloud cloud = random_cloud(kFewGaussians, 1, 0);
  Document document;
  edit(&document, NewObject{}, EditContext{cloud});
  edit(&document, SetSmoothness{1, 900.0f}, EditContext{cloud});
  CHECK(document.objects[0].smoothness == 500.0f);
  edit(&document, SetSmoothness{1, {}}, EditContext{cloud});
  CHECK_FALSE(document.objects[0].smoothness);
}

TEST_CASE("history: the background and the choice of an object are no steps, and undo leaves them") {
  const ScratchFolder folder("no_steps");
  write_random_scene(folder / "random.ply");
  StudioOptions options;
  options.inline_tasks = true;
  Studio studio(options);
  studio.apply(OpenScene{folder / "random.ply"});
  REQUIRE(studio.scene());
  studio.apply(NewObject{});
  const ObjectId first = studio.document().active;
  studio.apply(NewObject{});
  studio.apply(RenameObject{first, "mug"});
  studio.apply(Undo{});
  const std::size_t steps = studio.history().entries().size();
  const glm::vec3 red(1, 0, 0);
  studio.apply(SetBackground{red});
  studio.apply(ActivateObject{first});
  CHECK(studio.document().active == first);
  CHECK(studio.history().entries().size() == steps);
  REQUIRE(studio.history().can_redo());  // nothing that could be redone is lost
  studio.apply(Redo{});
  CHECK(studio.document().find(first)->name == "mug");
  CHECK(studio.document().active == first);
  CHECK(studio.document().background == red);
  studio.apply(ActivateObject{first + 77});  // there is none
  CHECK(studio.messages().back().kind == Message::Kind::kRefused);
  CHECK(studio.document().active == first);
  while (studio.history().can_undo()) studio.apply(Undo{});
  CHECK(studio.document().objects.empty());
  CHECK(studio.document().active_object() == nullptr);
  CHECK(studio.document().background == red);
}

TEST_CASE("history: a cut reaches every state with its inputs, and no other") {
  History history;
  history.push("click", with_click(history.now(), {3, 4}));
  const std::string key = history.keys(history.now().objects.front()).cut;
  CHECK(key == cut_key(history.now(), history.now().objects.front()));
  Document renamed = history.now();
  renamed.objects.front().name = "mug";
  history.push("rename", renamed);
  history.push("click", with_click(history.now(), {9, 9}));
  const Flags cut = make_flags(std::vector<std::uint8_t>(kFewGaussians, 1));
  history.set_cut(history.now().active, key, cut);
  CHECK(history.now().objects.front().cut == nullptr);
  CHECK(is_stale(history.now(), history.now().objects.front()));
  for (int i = 0; i < 2; ++i) {
    history.undo();
    CHECK(history.now().objects.front().cut == cut);
    CHECK_FALSE(is_stale(history.now(), history.now().objects.front()));
  }
}

TEST_CASE("history: keys are those of the document wherever it stands") {
  std::mt19937 random(5);
  History history;
  for (int i = 0; i < 60; ++i) {
    Document after = history.now();
    if (random() % 4 == 0) add_object(&after);
    if (random() % 5 == 0 && !after.objects.empty()) after.objects.erase(after.objects.begin());
    if (!after.find(after.active)) after.active = after.objects.empty() ? 0 : after.objects.back().id;
    if (random() % 3 == 0) after.preset = random() % 2 ? "paper" : "default";
    after = with_click(after, {random() % 60, random() % 40});
    history.push("step", after);
    if (random() % 3 == 0 && history.can_undo()) history.undo();
    for (const ObjectItem& object : history.now().objects) {
      CHECK(history.keys(object).cut == cut_key(history.now(), object));
      CHECK(history.keys(object).first_click == key_of_first_stroke(cut_request(history.now(), object)));
    }
  }
}

TEST_CASE("kept labels are those of the document, whatever of it changes") {
  std::mt19937 random(7);
  LabelCache cache;
  Document document;
  for (int i = 0; i < 4; ++i) add_object(&document);
  document.objects[2].within = document.objects[1].id;
  document.objects[3].within = document.objects[2].id;
  for (int i = 0; i < 200; ++i) {
    ObjectItem& object = document.objects[random() % document.objects.size()];
    switch (random() % 5) {
      case 0:
        object.cut = random_flags(random, 2);
        break;
      case 1:
        object.hand = random_flags(random, 3);
        break;
      case 2:
        document.deleted = random() % 2 ? random_flags(random, 2) : nullptr;
        break;
      case 3:
        if (&object != &document.objects.front()) object.within = document.objects.front().id;
        break;
      default:
        object.cut = nullptr;
    }
    for (const ObjectItem& o : document.objects) {
      const std::vector<std::uint8_t> labels = labels_of(document, o, kFewGaussians);
      CHECK(*cache.labels(document, o, kFewGaussians) == labels);
      CHECK(cache.count(document, o, kFewGaussians) == count_flags(labels));
    }
  }
}

TEST_CASE("edits asked for at once are made in order, as if each had been waited for") {
  const ScratchFolder folder("haste");
  write_random_scene(folder / "random.ply");
  const auto work_after = [&](bool haste, std::vector<std::string>* titles) {
    Studio studio({});
    studio.set_viewport(64, 48, 1);
    studio.apply(OpenScene{folder / "random.ply"});
    REQUIRE(studio.settle(300));
    const auto then = [&](const Command& command) {
      studio.apply(command);
      if (!haste) REQUIRE(studio.settle(60));
    };
    const float reach = 0.1f * studio.camera().scene_size();
    const glm::vec3 middle = studio.scene()->cloud->position.front();
    const glm::vec3 colour = base_colour(*studio.scene()->cloud, 0);
    then(NewObject{});
    then(SelectVolume{Volume{true, middle, glm::vec3(reach)}, SetOperation::kAdd, false});
    then(EditSelection{SelectionEdit::kGrow});
    then(RenameObject{1, "grown"});
    then(EditSelection{SelectionEdit::kInvert});
    then(Undo{});
    then(SelectColour{colour, 0.02f, SetOperation::kRemove});
    then(EditSelection{SelectionEdit::kLargestPart});
    then(DuplicateObject{1});
    then(RecolourObject{1, {1, 2, 3}});
    REQUIRE(studio.settle(60));
    for (const History::Entry& entry : studio.history().entries()) titles->push_back(entry.title);
    CHECK(studio.gaussians_of(1) > 0);
    return Document(studio.document());
  };
  std::vector<std::string> in_haste, waited_for;
  CHECK(same(work_after(true, &in_haste), work_after(false, &waited_for)));
  CHECK(in_haste == waited_for);
}

TEST_CASE("edits that were asked for and cancelled leave the document as it was") {
  const ScratchFolder folder("cancelled");
  write_random_scene(folder / "random.ply");
  Studio studio({});
  studio.set_viewport(64, 48, 1);
  studio.apply(OpenScene{folder / "random.ply"});
  REQUIRE(studio.settle(300));
  studio.apply(NewObject{});
  const Document before = studio.document();
  studio.apply(EditSelection{SelectionEdit::kAll});
  studio.apply(EditSelection{SelectionEdit::kInvert});
  studio.apply(RenameObject{1, "never"});
  studio.apply(SaveWork{folder / "kept.splatcut.json"});
  studio.apply(Cancel{});
  REQUIRE(studio.settle(60));
  CHECK(std::filesystem::exists(folder / "kept.splatcut.json"));  // a file that was asked for is no edit
  CHECK(same(studio.document(), before));
  studio.apply(RenameObject{1, "afterwards"});
  CHECK(studio.document().objects.front().name == "afterwards");
}
