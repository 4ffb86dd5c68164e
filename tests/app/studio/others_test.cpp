// What objects leave to one another: however they are begun, while others are still cut, given back and
// saved.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/cli/work_cut.h"
#include "app/document/document_edits.h"
#include "app/work/work_file.h"
#include "hands.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Labels = std::vector<std::uint8_t>;

std::size_t shared(const Labels& a, const Labels& b) {
  std::size_t both = 0;
  for (std::size_t g = 0; g < a.size(); ++g) both += a[g] && b[g];
  return both;
}

// The small sample with its apple as object 1, and what else the cases below do in it.
constexpr glm::vec2 kAppleFrom{605, 415}, kAppleTo{735, 560};  // around it
constexpr glm::vec2 kLeft = kOnApple - glm::vec2(35, 0), kRight = kOnApple + glm::vec2(35, 0);

struct Others : Hands {
  explicit Others(bool cut = true) : Hands(cut) {}
  Camera camera() { return studio().viewport().pane_camera(); }
  glm::vec2 place(const glm::vec2& on_sample) { return in_viewport(app.screen_of(on_sample)); }
  void settle() { REQUIRE(app.settle()); }
  void click(const glm::vec2& on_sample, SeedLabel label = SeedLabel::kObject) {
    studio().apply(AddStroke{camera(), {label, 4, {place(on_sample)}}});
  }
  void begin_second_while_first_comes() {
    click(kLeft);
    click(kRight, SeedLabel::kRest);
    studio().apply(NewObject{});
    click(kRight);
  }
  // A box between two places of the sample.
  void box(const glm::vec2& a, const glm::vec2& b) { studio().apply(AddBox{camera(), place(a), place(b)}); }
  // By hand, through all that is seen left of a place.
  void take_left_of(const glm::vec2& on_sample, SetOperation operation) {
    ViewState view = studio().view();
    view.see_through = true;
    studio().apply(SetView{view});
    const Camera now = camera();
    studio().apply(SelectRegion{
        now, rectangle_region({0, 0}, {place(on_sample).x, now.height_px}, now.width_px, now.height_px),
        operation});
    settle();
  }
  Labels labels(ObjectId object) { return studio().labels(object); }
};

}  // namespace

TEST_CASE("others: an object begun by a box leaves to the others what they have, unless that fills the box") {
  Others hands;
  Studio& studio = hands.studio();
  const Labels apple = hands.labels(1);
  const auto boxed = [&] {
    studio.apply(NewObject{});
    hands.box(kAppleFrom, kAppleTo);
    hands.settle();
    return studio.document().active;
  };
  CHECK(shared(hands.labels(boxed()), apple) > count_flags(apple) / 2);
  studio.apply(RemoveObject{studio.document().active});
  studio.apply(ActivateObject{1});
  hands.take_left_of(kOnApple, SetOperation::kIntersect);
  const Labels left = hands.labels(1);
  REQUIRE(count_flags(left) > 0);
  const ObjectId right = boxed();
  CHECK(hands.selected() > 0);
  CHECK(shared(hands.labels(right), left) == 0);
  studio.apply(LeaveToOthers{right, false});
  hands.settle();
  CHECK(2 * shared(hands.labels(right), left) > count_flags(left));  // the box takes it without
}

TEST_CASE("others: whether an object is without the others is known anew after each step") {
  Others hands;
  Studio& studio = hands.studio();
  hands.box(kAppleFrom, kAppleTo);
  studio.apply(NewObject{});
  hands.take_left_of(kOnApple, SetOperation::kAdd);
  std::vector<bool> answers;
  const auto ask = [&] {
    hands.settle();
    for (const ObjectItem& object : studio.document().objects) {
      answers.push_back(is_without_others(studio.document(), object, studio.scene()->cloud->size()));
      for (int again = 0; again < 2; ++again) CHECK(studio.is_without_others(object.id) == answers.back());
    }
  };
  ask();
  for (const bool leaves : {true, false, true}) {
    studio.apply(LeaveToOthers{2, leaves});
    ask();
  }
  for (const bool locked : {true, false}) {
    studio.apply(LockObject{1, locked});
    ask();
  }
  for (int i = 0; i < 5; ++i) {
    studio.apply(Undo{});
    ask();
  }
  CHECK(std::ranges::count(answers, true) > 2);
  CHECK(std::ranges::count(answers, false) > 2);
}

TEST_CASE("others: a box that two others fill together, neither of them by more than half, leaves both out") {
  constexpr std::size_t kCount = 10;
  const GaussianCloud cloud = random_cloud(kCount, 1, 0);
  const EditContext context{cloud};
  Document document;
  const auto has = [&](std::size_t from, std::size_t to) {
    Labels labels(kCount, 0);
    std::fill(labels.begin() + static_cast<std::ptrdiff_t>(from),
              labels.begin() + static_cast<std::ptrdiff_t>(to), std::uint8_t{1});
    set_labels(&document, &add_object(&document), labels);
  };
  has(0, 4);
  has(4, 7);
  add_object(&document);
  AddBox box{look_at({0, 0, -5}, {0, 0, 0}, {0, -1, 0}, 1, 100, 100), {10, 10}, {90, 90}};
  box.hits = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  Document boxed = document;
  edit(&boxed, box, context);
  REQUIRE(boxed.active_object()->of_others);
  CHECK(count_flags(*boxed.active_object()->of_others) == 7);
  box.hits = {0, 1, 2, 3, 4, 5, 9};  // the first alone has more than half: it alone shares
  boxed = document;
  edit(&boxed, box, context);
  REQUIRE(boxed.active_object()->of_others);
  CHECK(*boxed.active_object()->of_others == Labels{0, 0, 0, 0, 1, 1, 1, 0, 0, 0});
  // A later one means what was left, also where nobody has it any more.
  box.hits = {7, 8, 9};
  boxed = document;
  edit(&boxed, box, context);
  edit(&boxed, RemoveObject{1}, context);
  box.hits = {0, 1, 2, 7, 8};
  edit(&boxed, box, context);
  REQUIRE(boxed.active_object()->of_others);
  CHECK(*boxed.active_object()->of_others == Labels{0, 0, 0, 0, 1, 1, 1, 0, 0, 0});
}

TEST_CASE("others: what another object gets while this one is begun is left to it, too") {
  const ScratchFolder folder("others_come");
  Others hands(false);
  Studio& studio = hands.studio();
  hands.begin_second_while_first_comes();
  REQUIRE(hands.labels(1) == Labels(studio.scene()->cloud->size(), 0));  // on its way
  CHECK(studio.document().find(2)->leaves_also == std::vector<ObjectId>{1});
  const auto scene = open_scene(kSmallSample);
  write_work_file(folder / "begun.splatcut.json", *scene, studio.document());
  hands.settle();
  const Labels left = hands.labels(1), beside = hands.labels(2);
  REQUIRE(count_flags(left) > 0);
  CHECK(count_flags(beside) > 0);
  CHECK(shared(beside, left) == 0);
  CHECK(studio.document().find(2)->leaves_also.empty());
  // Undone and redone, and from a file that was written in between.
  studio.apply(Undo{});
  studio.apply(Redo{});
  hands.settle();
  CHECK(hands.labels(2) == beside);
  Others again(false);
  again.app.open(folder / "begun.splatcut.json");
  again.settle();
  CHECK(again.labels(1) == left);
  CHECK(again.labels(2) == beside);
  const Document computed =
      computed_again(*scene, restored(read_work_file(folder / "begun.splatcut.json"), *scene).document);
  CHECK(labels_of(computed, *computed.find(1), left.size()) == left);
  CHECK(labels_of(computed, *computed.find(2), left.size()) == beside);
  studio.apply(LeaveToOthers{2, false});
  hands.settle();
  CHECK(shared(hands.labels(2), left) > 0);  // it takes that without
}

TEST_CASE(
    "others: what an object gets that was removed or given up meanwhile is left to it when it comes after "
    "all") {
  Others hands(false);
  Studio& studio = hands.studio();
  hands.begin_second_while_first_comes();
  bool settled = true;  // before it comes
  SUBCASE("removed, and undone") {
    studio.apply(RemoveObject{1});
    settled = hands.app.settle();
    CHECK(count_flags(hands.labels(2)) > 0);
    studio.apply(Undo{});
  }
  SUBCASE("given up, and computed after all") {
    hands.app.frames(1);
    REQUIRE(studio.cuts().cutting() == 1);
    studio.apply(Cancel{});
    settled = hands.app.settle();
    CHECK(count_flags(hands.labels(1)) == 0);
    studio.apply(ActivateObject{1});
    studio.apply(Recompute{});
  }
  REQUIRE(settled);
  hands.settle();
  const Labels left = hands.labels(1), beside = hands.labels(2);
  REQUIRE(count_flags(left) > 0);
  CHECK(count_flags(beside) > 0);
  CHECK(shared(beside, left) == 0);
  CHECK(studio.document().find(2)->leaves_also.empty());
  studio.apply(LeaveToOthers{2, false});
  hands.settle();
  CHECK(shared(hands.labels(2), left) > 0);
}

TEST_CASE("others: an object begun on what another one then gets shares it") {
  Others hands(false);
  Studio& studio = hands.studio();
  hands.click(kOnApple);
  studio.apply(NewObject{});
  hands.click(kOnApple + glm::vec2(4, 0));
  const Document begun = studio.document();
  hands.settle();
  const Labels apple = hands.labels(1);
  REQUIRE(count_flags(apple) > 0);
  CHECK(shared(hands.labels(2), apple) > count_flags(apple) / 2);
  const Document computed = computed_again(*open_scene(kSmallSample), begun);
  CHECK(labels_of(computed, *computed.find(2), apple.size()) == hands.labels(2));
}

TEST_CASE("others: of two objects begun while a third is cut the earlier one leaves nothing to the later") {
  Others hands(false);
  Studio& studio = hands.studio();
  hands.click(kOnMug);
  studio.apply(NewObject{});
  hands.begin_second_while_first_comes();
  hands.settle();
  const Labels second = hands.labels(2), third = hands.labels(3);
  CHECK(count_flags(second) > 0);
  CHECK(count_flags(third) > 0);
  CHECK(shared(third, second) == 0);
  studio.apply(LeaveToOthers{2, false});  // it was begun first: it gave nothing to the third
  hands.settle();
  CHECK(hands.labels(2) == second);
}

TEST_CASE("others: what a click would take is outlined without what the others have") {
  Others hands;
  Studio& studio = hands.studio();
  const Labels apple = hands.labels(1);
  hands.take_left_of(kOnApple, SetOperation::kIntersect);
  const Labels left = hands.labels(1);
  REQUIRE(shared(left, apple) > 0);
  studio.apply(NewObject{});
  const glm::vec2 at = hands.app.screen_of(kOnApple) + glm::vec2(14, 0);
  hands.app.move(at);
  hands.settle();
  REQUIRE(studio.viewport().style(0).highlight);
  const Labels outlined = *studio.viewport().style(0).highlight;
  hands.app.click(at);
  hands.settle();
  const Labels taken = hands.labels(studio.document().active);
  CHECK(count_flags(outlined) > 0);
  CHECK(shared(outlined, left) == 0);
  CHECK(iou_of(outlined, taken) > 0.6);
}

TEST_CASE("others: thumbnails show from the first what the object gets of its cut, not what others keep") {
  Others hands;
  Studio& studio = hands.studio();
  const Labels apple = hands.labels(1);
  studio.apply(NewObject{});
  hands.click(kOnApple + glm::vec2(0, 75));  // the table
  hands.settle();
  const ObjectId table = studio.document().active;
  const auto run = [&] { return studio.cuts().run(table); };
  bool holds_apple = false;
  for (const int step : {1, -1}) {
    studio.apply(StepScale{step});
    // Until the pictures of this cut are there, and no frame longer.
    REQUIRE(hands.app.frames_until(
        [&] { return !studio.cuts().comes(*studio.document().find(table)) && run() && run()->views_drawn; }));
    const Labels drawn = run()->views_labels ? *run()->views_labels : run()->result->labels;
    CHECK(drawn == hands.labels(table));
    CHECK(shared(drawn, apple) == 0);
    holds_apple |= shared(run()->result->labels, apple) > 0;
    const std::uint64_t serial = run()->views.front().serial;
    hands.settle();
    if (step > 0) CHECK(run()->views.front().serial == serial);  // once is enough
  }
  CHECK(holds_apple);
}

TEST_CASE("others: what hands took and left to the others is the object's again where it is given back") {
  const ScratchFolder folder("given_back");
  Others hands;
  Studio& studio = hands.studio();
  const Labels apple = hands.labels(1);
  studio.apply(NewObject{});
  hands.take_left_of(kOnApple, SetOperation::kAdd);
  const ObjectId by_hand = studio.document().active;
  studio.apply(LeaveToOthers{by_hand, false});
  hands.settle();
  const Labels before = hands.labels(by_hand);
  REQUIRE(shared(before, apple) > 0);
  studio.apply(LeaveToOthers{by_hand, true});
  hands.settle();
  CHECK(shared(hands.labels(by_hand), apple) == 0);
  studio.apply(SaveWork{folder / "left.splatcut.json"});
  hands.settle();
  studio.apply(LeaveToOthers{by_hand, false});
  hands.settle();
  CHECK(hands.labels(by_hand) == before);

  Others other(false);
  other.app.open(folder / "left.splatcut.json");
  other.settle();
  CHECK(shared(other.labels(by_hand), apple) == 0);
  other.studio().apply(LeaveToOthers{by_hand, false});
  other.settle();
  CHECK(other.labels(by_hand) == before);
}

TEST_CASE("others: what hands took out does not come back where what was left to others is given back") {
  constexpr std::size_t kCount = 6;
  const GaussianCloud cloud = random_cloud(kCount, 1, 0);
  const EditContext context{cloud};
  Document document;
  set_labels(&document, &add_object(&document), Labels{1, 1, 1, 0, 0, 0});
  ObjectItem& two = add_object(&document);
  two.cut = make_flags({1, 0, 1, 1, 0, 0});
  set_labels(&document, &two, Labels{1, 1, 1, 1, 1, 0});
  edit(&document, LeaveToOthers{2, true}, context);
  REQUIRE(labels_of(document, two, kCount) == Labels{0, 0, 0, 1, 1, 0});
  const auto given_back = [&](Document then) {
    edit(&then, LeaveToOthers{2, false}, context);
    return labels_of(then, *then.find(2), kCount);
  };
  CHECK(given_back(document) == Labels{1, 1, 1, 1, 1, 0});
  Document none = document, removed = document, kept = document, separate = document;
  edit(&none, EditSelection{SelectionEdit::kNone}, context);
  CHECK(given_back(none) == Labels(kCount, 0));
  edit_selection(&removed, Labels{1, 1, 0, 1, 0, 0}, SetOperation::kRemove, context);
  CHECK(given_back(removed) == Labels{0, 0, 1, 0, 1, 0});
  edit_selection(&kept, Labels{0, 1, 1, 1, 0, 0}, SetOperation::kIntersect, context);
  CHECK(given_back(kept) == Labels{0, 1, 1, 1, 0, 0});
  edit(&separate, SeparateObject{1}, context);
  CHECK(given_back(separate) == Labels{0, 0, 0, 1, 1, 0});
}

TEST_CASE("others: work says by its version that it holds what is left to others, and older work opens") {
  const ScratchFolder folder("work_version");
  const auto file = folder / "two.splatcut.json";
  const auto scene = open_scene(kSmallSample);
  Document document;
  add_object(&document, "one");
  ObjectItem& two = add_object(&document, "two");
  Labels some(scene->cloud->size(), 0);
  some[3] = 1;
  two.of_others = make_flags(some);
  write_work_file(file, *scene, document);
  nlohmann::json work = nlohmann::json::parse(std::ifstream(file));
  CHECK(work["splatcut_work"] == 9);  // a program that knows up to 7 refuses it in words
  const RestoredWork read = restored(read_work_file(file), *scene);
  REQUIRE(read.document.find(2)->of_others);
  CHECK(*read.document.find(2)->of_others == some);
  work["splatcut_work"] = 7;  // as it was written by the program before that number
  std::ofstream(file) << work;
  const RestoredWork older = restored(read_work_file(file), *scene);
  REQUIRE(older.document.find(2)->of_others);
  CHECK(*older.document.find(2)->of_others == some);
}

TEST_CASE(
    "others: an object begun by a lasso leaves to the others what they have, as by a box, and so do later "
    "ones") {
  Others hands;
  Studio& studio = hands.studio();
  const Labels apple = hands.labels(1);
  studio.apply(NewObject{});
  hands.take_left_of(kOnApple, SetOperation::kAdd);  // half of the apple, and all that is left of it
  CHECK(hands.said().find("Others keep ") != std::string::npos);
  const Labels first = hands.labels(2);
  CHECK(count_flags(first) > 0);
  CHECK(shared(first, apple) == 0);
  hands.take_left_of(kOnApple + glm::vec2(400, 0), SetOperation::kAdd);  // all of the apple, and more
  const Labels more = hands.labels(2);
  CHECK(count_flags(more) > count_flags(first));
  CHECK(shared(more, apple) == 0);
  studio.apply(Undo{});
  hands.settle();
  CHECK(hands.labels(2) == first);
  studio.apply(Redo{});
  studio.apply(LeaveToOthers{2, false});
  hands.settle();
  CHECK(shared(hands.labels(2), apple) == count_flags(apple));  // given by hand
}

TEST_CASE("others: a shape that is mostly another's takes what it holds, and nothing else of that") {
  constexpr std::size_t kCount = 8;
  const GaussianCloud cloud = random_cloud(kCount, 1, 0);
  const EditContext context{cloud};
  Document document;
  set_labels(&document, &add_object(&document), Labels{1, 1, 1, 1, 0, 0, 0, 0});
  ObjectItem& two = add_object(&document);
  edit_by_shape(&document, Labels{0, 0, 0, 1, 1, 1, 0, 0}, SetOperation::kAdd, context);
  CHECK(labels_of(document, two, kCount) == Labels{0, 0, 0, 0, 1, 1, 0, 0});
  edit_by_shape(&document, Labels{0, 0, 1, 0, 1, 1, 0, 0}, SetOperation::kAdd, context);  // new is one alone
  CHECK(labels_of(document, two, kCount) == Labels{0, 0, 1, 0, 1, 1, 0, 0});
  edit_by_shape(&document, Labels{0, 1, 0, 1, 0, 0, 1, 1}, SetOperation::kAdd, context);
  CHECK(labels_of(document, two, kCount) == Labels{0, 0, 1, 0, 1, 1, 1, 1});
  edit_by_shape(&document, Labels{0, 0, 1, 0, 1, 0, 0, 0}, SetOperation::kRemove, context);
  CHECK(labels_of(document, two, kCount) == Labels{0, 0, 0, 0, 0, 1, 1, 1});
  ObjectItem& three = add_object(&document);  // begun on the first
  edit_by_shape(&document, Labels{1, 1, 1, 0, 0, 0, 0, 1}, SetOperation::kAdd, context);
  CHECK(labels_of(document, three, kCount) == Labels{1, 1, 1, 0, 0, 0, 0, 1});
}

TEST_CASE("others: what is locked no other object takes, by clicks, boxes, shapes or all that is selected") {
  Others hands;
  Studio& studio = hands.studio();
  const Labels apple = hands.labels(1);
  studio.apply(LockObject{1, true});
  studio.apply(NewObject{});
  hands.click(kOnApple);  // as it would be a part of it, or share
  hands.settle();
  CHECK(hands.said() ==
        "Object 1: is locked, and no other object takes what it has. Unlock it in the objects panel.");
  CHECK(hands.selected() == 0);
  hands.box(kAppleFrom, kAppleTo);
  hands.settle();
  CHECK(shared(hands.labels(2), apple) == 0);
  hands.click(kOnOrange);
  hands.settle();
  REQUIRE(hands.selected() > 0);
  hands.take_left_of(kOnApple, SetOperation::kAdd);
  CHECK(shared(hands.labels(2), apple) == 0);
  CHECK(hands.said().find(". What is locked keeps ") != std::string::npos);
  hands.app.key('A', {.ctrl = true});
  hands.settle();
  CHECK(shared(hands.labels(2), apple) == 0);
  CHECK(hands.selected() == apple.size() - count_flags(apple));
  CHECK(hands.said().find("are selected. What is locked keeps ") != std::string::npos);
  studio.apply(LeaveToOthers{2, false});
  hands.settle();
  CHECK(shared(hands.labels(2), apple) == 0);
  CHECK(hands.labels(1) == apple);
  studio.apply(LockObject{1, false});
  hands.app.key('A', {.ctrl = true});
  hands.settle();
  CHECK(hands.selected() == apple.size());
}

TEST_CASE("others: a lock takes nothing that another object shared before, and keeps it from deletion") {
  constexpr std::size_t kCount = 6;
  const GaussianCloud cloud = random_cloud(kCount, 1, 0);
  const EditContext context{cloud};
  Document document;
  set_labels(&document, &add_object(&document), Labels{1, 1, 1, 0, 0, 0});
  ObjectItem& two = add_object(&document);
  two.cut = make_flags({0, 1, 0, 1, 0, 0});
  edit(&document, LockObject{1, true}, context);
  CHECK(labels_of(document, *document.find(2), kCount) == Labels{0, 1, 0, 1, 0, 0});
  document.find(2)->cut = make_flags({1, 1, 1, 1, 1, 0});  // its next size
  CHECK(labels_of(document, *document.find(2), kCount) == Labels{0, 1, 0, 1, 1, 0});
  CHECK_FALSE(is_without_others(document, *document.find(2), kCount));  // that is a choice of its own
  document.active = 2;
  CHECK(edit(&document, DeleteSelected{}, context).find("What is locked keeps 1 Gaussian") !=
        std::string::npos);
  CHECK(labels_of(document, *document.find(1), kCount) == Labels{1, 1, 1, 0, 0, 0});
}
