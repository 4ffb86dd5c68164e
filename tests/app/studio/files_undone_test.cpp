// Undoing, redoing and stopping changes of the scene's files, and opening another scene over work.
#include <doctest/doctest.h>

#include <algorithm>

#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE(
    "several scenes: adding, placing and taking out are undone and redone, with what was made meanwhile") {
  const ScratchFolder folder("several_undone");
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = active_by_row(studio);
  add(hands, small_scene(folder));
  studio.apply(NewObject{});
  studio.apply(SelectScene{last_file(hands).id});
  REQUIRE(hands.selected() == kAdded);
  const ObjectId object = studio.document().active;
  const ScenePlace aside{{1, 2, 3}, {0, 45, 0}, 2};
  studio.apply(PlaceScene{last_file(hands).id, aside});
  REQUIRE(hands.app.settle());
  const GaussianCloud placed = *studio.scene()->cloud;
  studio.apply(RemoveScene{last_file(hands).id});
  REQUIRE(hands.app.settle());
  CHECK(studio.gaussians_of(object) == 0);
  const auto go = [&](Action action) {
    REQUIRE(studio.why_not(action).empty());
    studio.run(action);
    REQUIRE(hands.app.settle());
  };
  go(Action::kUndo);
  CHECK(same_cloud(*studio.scene()->cloud, placed));
  CHECK(studio.gaussians_of(object) == kAdded);  // its marks came back with it
  CHECK(last_file(hands).place == aside);
  go(Action::kUndo);
  CHECK(last_file(hands).place == ScenePlace{});
  CHECK(studio.gaussians_of(object) == kAdded);
  go(Action::kUndo);  // the selection
  CHECK(studio.gaussians_of(object) == 0);
  go(Action::kRedo);
  CHECK(studio.gaussians_of(object) == kAdded);
  go(Action::kUndo);
  go(Action::kUndo);  // the object
  go(Action::kUndo);  // the file
  CHECK(studio.scene()->files.size() == 1);
  CHECK(active_by_row(studio) == apple);
  go(Action::kRedo);
  CHECK(studio.scene()->files.size() == 2);
  CHECK(active_by_row(studio) == longer(apple, kAdded));
  go(Action::kUndo);
  studio.apply(EditSelection{SelectionEdit::kNone});  // another way on: nothing is left to redo
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.why_not(Action::kRedo).empty());
}

TEST_CASE("several scenes: what was saved is known apart from what was done after files were taken back") {
  const ScratchFolder folder("several_serials");
  Hands hands;
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  studio.apply(NewObject{});
  studio.apply(SaveWork{folder / "two.splatcut.json"});
  REQUIRE(hands.app.settle());
  REQUIRE_FALSE(studio.unsaved());
  studio.apply(Undo{});  // the object
  studio.apply(Undo{});  // the file
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 1);
  for (int step = 0; step < 8; ++step) {  // as many steps as lay between: none of these documents is saved
    CHECK(studio.unsaved());
    studio.apply(NewObject{});
  }
}

namespace {

void place(Hands& hands, float x) {
  hands.studio().apply(PlaceScene{last_file(hands).id, {{x, 0, 0}}});
  REQUIRE(hands.app.settle());
}

void go(Hands& hands, Action action) {
  REQUIRE(hands.studio().why_not(action).empty());
  hands.studio().run(action);
  REQUIRE(hands.app.settle());
}

float placed_x(Hands& hands) {
  return last_file(hands).place.move.x;
}

}  // namespace

TEST_CASE("files undone: many changes of small scenes one by one, and redone") {
  const ScratchFolder folder("files_many");
  Hands hands;
  add(hands, small_scene(folder));
  constexpr int kPlaced = 6;
  for (int i = 1; i <= kPlaced; ++i) place(hands, static_cast<float>(i));
  for (int i = kPlaced - 1; i >= 0; --i) {
    go(hands, Action::kUndo);
    CHECK(placed_x(hands) == static_cast<float>(i));
  }
  for (int i = 1; i <= kPlaced; ++i) {
    go(hands, Action::kRedo);
    CHECK(placed_x(hands) == static_cast<float>(i));
  }
}

TEST_CASE("files undone: a scene that is no longer kept is said, and the steps before it can be undone") {
  const ScratchFolder folder("files_not_kept");
  ApplicationOptions options = with_kept_scenes();
  options.studio.most_kept_gaussians = 0;
  Hands hands(true, options);
  const auto apple = hands.selected();
  add(hands, small_scene(folder));
  for (int i = 1; i <= 3; ++i) place(hands, static_cast<float>(i));
  for (int i = 2; i >= 0; --i) {
    go(hands, Action::kUndo);
    CHECK(placed_x(hands) == static_cast<float>(i));
  }
  CHECK(hands.said().starts_with("Undone: "));
  go(hands, Action::kUndo);
  CHECK(hands.said().starts_with("Not undone: "));
  CHECK(hands.studio().scene()->files.size() == 2);
  CHECK(hands.selected() == apple);
  go(hands, Action::kUndo);  // the click
  CHECK(hands.selected() == 0);
  go(hands, Action::kRedo);
  CHECK(hands.said().starts_with("Redone: "));
  CHECK(hands.selected() == apple);
  go(hands, Action::kRedo);  // the file, which was there all the time
  CHECK(hands.said().starts_with("Nothing to redo: "));
  CHECK(hands.selected() == apple);
  go(hands, Action::kRedo);
  CHECK(hands.said().starts_with("Redone: "));
  CHECK(placed_x(hands) == 1);
}

TEST_CASE("files undone: redo goes on behind a step that was undone further, and after what is no step") {
  const ScratchFolder folder("files_redo");
  Hands hands;
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  go(hands, Action::kUndo);  // the file
  REQUIRE(studio.scene()->files.size() == 1);
  go(hands, Action::kUndo);  // the click
  REQUIRE(hands.selected() == 0);
  go(hands, Action::kRedo);
  go(hands, Action::kBackdrop);
  studio.apply(ActivateObject{0});
  go(hands, Action::kRedo);
  CHECK(studio.scene()->files.size() == 2);
}

TEST_CASE("files undone: a step that is chosen in the list takes back the files that came after it") {
  const ScratchFolder folder("files_jump");
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = active_by_row(studio);
  const std::size_t clicked = studio.history().cursor();
  add(hands, small_scene(folder, "a.ply", 1));
  studio.apply(NewObject{});
  add(hands, small_scene(folder, "b.ply", 2));
  place(hands, 3);
  const auto jump = [&](std::size_t entry) {
    studio.apply(JumpHistory{entry});
    REQUIRE(hands.app.settle());
  };
  const std::size_t a_added = clicked + 1, object_made = clicked + 2;
  jump(object_made);
  CHECK(studio.scene()->files.size() == 2);
  CHECK(studio.document().objects.size() == 2);
  jump(a_added);
  CHECK(studio.scene()->files.size() == 2);
  CHECK(studio.document().objects.size() == 1);
  jump(object_made);
  CHECK(studio.document().objects.size() == 2);
  jump(clicked);
  CHECK(studio.scene()->files.size() == 1);
  CHECK(active_by_row(studio) == apple);
  go(hands, Action::kRedo);
  CHECK(studio.scene()->files.size() == 2);
}

TEST_CASE("files undone: steps behind the changes that were undone are listed, and can be chosen") {
  const ScratchFolder folder("files_ahead");
  Hands hands;
  Studio& studio = hands.studio();
  const std::size_t clicked = studio.history().cursor();
  add(hands, small_scene(folder, "a.ply", 1));
  studio.apply(NewObject{});
  place(hands, 3);
  studio.apply(SelectScene{last_file(hands).id});
  studio.apply(EditSelection{SelectionEdit::kNone});
  REQUIRE(hands.app.settle());
  std::vector<std::string> titles;
  for (const History::Entry& step : studio.history().entries()) titles.push_back(step.title);
  const auto jump = [&](std::size_t entry) {
    studio.apply(JumpHistory{entry});
    REQUIRE(hands.app.settle());
  };
  const auto listed = [&] {
    std::vector<std::string> all;
    for (const History::Entry& step : studio.history().entries()) all.push_back(step.title);
    for (const std::string& title : studio.files().redo_titles()) all.push_back(title);
    return all;
  };
  const auto lists_the_same = [&] {  // rows behind the end name their objects, too
    return std::ranges::equal(listed(), titles, [](const std::string& row, const std::string& title) {
      return row.starts_with(title);
    });
  };
  const std::size_t a_added = clicked + 1, object_made = clicked + 2, placed = clicked + 3,
                    selected = clicked + 4, last = clicked + 5;
  REQUIRE(titles.size() == last + 1);
  CHECK(lists_the_same());
  for (const std::size_t entry : {clicked, object_made, std::size_t{0}, selected, a_added, placed, clicked,
                                  last, std::size_t{1}, std::size_t{0}, last}) {
    CAPTURE(entry);
    jump(entry);
    CHECK(studio.history().cursor() == entry);
    CHECK(hands.said() == "Now at: " + titles[entry]);
    CHECK(lists_the_same());
    CHECK(studio.scene()->files.size() == (entry >= a_added ? 2 : 1));
    CHECK(studio.scene()->files.back().place.move.x == (entry >= placed ? 3 : 0));
    CHECK(studio.document().objects.size() == (entry >= object_made ? 2 : entry >= clicked ? 1 : 0));
    CHECK(hands.selected() == (entry == selected ? kAdded : hands.selected()));
  }
  const std::size_t beyond = titles.size();
  jump(0);
  jump(beyond);
  CHECK(hands.said().find("There is no such step") != std::string::npos);
}

TEST_CASE("files undone: what was undone before another way was taken does not come back") {
  const ScratchFolder folder("files_other_way");
  Hands hands;
  Studio& studio = hands.studio();
  add(hands, small_scene(folder, "a.ply", 1));
  add(hands, small_scene(folder, "b.ply", 2));
  go(hands, Action::kUndo);  // b
  studio.apply(NewObject{});
  go(hands, Action::kUndo);  // the object
  go(hands, Action::kUndo);  // a
  go(hands, Action::kRedo);
  go(hands, Action::kRedo);
  CHECK(studio.scene()->files.size() == 2);
  CHECK(studio.document().objects.size() == 2);
  CHECK_FALSE(studio.why_not(Action::kRedo).empty());
}

TEST_CASE("files undone: undo stops a change of files that is under way, not the step before it") {
  const ScratchFolder folder("files_under_way");
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = hands.selected();
  add(hands, small_scene(folder));
  studio.apply(PlaceScene{last_file(hands).id, {{3, 0, 0}}});
  REQUIRE(studio.files().changing());
  go(hands, Action::kUndo);
  CHECK(placed_x(hands) == 0);
  CHECK(studio.scene()->files.size() == 2);
  CHECK(hands.selected() == apple);
  go(hands, Action::kUndo);
  CHECK(studio.scene()->files.size() == 1);
}

TEST_CASE("files undone: nothing is made that another scene on its way would replace") {
  Hands hands(false);
  Studio& studio = hands.studio();
  const AddStroke on_apple{studio.viewport().pane_camera(),
                           click(hands.in_viewport(hands.app.screen_of(kOnApple)), SeedLabel::kObject)};
  // Without a frame between: the scene is on its way until one takes it, however fast it was read.
  studio.apply(OpenScene{kSmallSample});
  studio.apply(on_apple);
  CHECK(studio.document().objects.empty());
  CHECK(hands.said().find("that keeps this scene") != std::string::npos);
  studio.apply(AddScene{kSmallSample});
  CHECK(hands.said().find("that keeps this scene") != std::string::npos);
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  hands.app.click(hands.app.screen_of(kOnApple));
  CHECK(hands.selected() > 0);
  CHECK(studio.scene()->files.size() == 1);
}

TEST_CASE("files undone: what is saved behind an undo that waits is written, of the files that are back") {
  const ScratchFolder folder("files_saved_behind");
  Hands hands;
  Studio& studio = hands.studio();
  const std::size_t before = studio.scene()->cloud->size();
  add(hands, small_scene(folder));
  studio.apply(EditSelection{SelectionEdit::kGrow});
  studio.apply(Undo{});
  studio.apply(Undo{});  // the file
  studio.apply(SaveWork{folder / "work.splatcut.json"});
  studio.apply(Export{{ExportWhat::kScene, SceneFormat::kPly, folder / "scene.ply"}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 1);
  CHECK(std::filesystem::exists(folder / "work.splatcut.json"));
  REQUIRE(std::filesystem::exists(folder / "scene.ply"));
  CHECK(load_scene(folder / "scene.ply").cloud.size() == before);
}
