// What was asked for is done, or it is said that it is not: commands that wait, scenes that are opened
// meanwhile, cuts that fail.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "app/document/words.h"
#include "scene/formats/scene_file.h"
#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Without a frame, so that its cut has not begun.
void click_at_once(Hands& hands, const glm::vec2& at) {
  hands.studio().apply(AddStroke{hands.studio().viewport().pane_camera(),
                                 {SeedLabel::kObject, 4, {hands.in_viewport(hands.app.screen_of(at))}}});
  REQUIRE(hands.studio().cuts().next() != 0);
}

bool was_said(Hands& hands, const std::string& words) {
  return std::ranges::any_of(hands.studio().messages(), [&](const Message& message) {
    return message.text.find(words) != std::string::npos;
  });
}

bool is_step(Hands& hands, const std::string& title) {
  return std::ranges::any_of(hands.studio().history().entries(), [&](const History::Entry& entry) {
    return entry.title.find(title) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("nothing lost: what hands take away while the cut runs is gone after it") {
  Hands patient, hasty(false);
  const Camera camera = patient.studio().viewport().pane_camera();
  const glm::vec2 apple = patient.in_viewport(patient.app.screen_of(kOnApple));
  Mask left(camera.width_px, camera.height_px, 0);
  for (int y = 0; y < left.height(); ++y)
    for (int x = 0; x < static_cast<int>(apple.x); ++x) left.at(x, y) = 1;
  Volume ball = {.round = true};
  ball.centre_world = patient.under(patient.app.screen_of(kOnApple));
  ball.half = glm::vec3(0.02f * patient.studio().camera().scene_size());
  Command command;
  SUBCASE("a region") {
    command = SelectRegion{camera, left, SetOperation::kRemove};
  }
  SUBCASE("all but a region") {
    command = SelectRegion{camera, left, SetOperation::kIntersect};
  }
  SUBCASE("a volume") {
    command = SelectVolume{ball, SetOperation::kRemove};
  }
  SUBCASE("a range") {
    command = SelectRange{Property::kOpacity, 0, 1, SetOperation::kRemove};
  }
  SUBCASE("a colour") {
    command = SelectColour{{0.7f, 0.2f, 0.15f}, 0.25f, SetOperation::kRemove};
  }
  const std::size_t before = patient.selected();
  patient.studio().apply(command);
  const std::size_t after = patient.selected();
  REQUIRE(after < before);
  click_at_once(hasty, kOnApple);
  hasty.studio().apply(command);
  CHECK(was_said(hasty, "as soon as"));
  CHECK(static_cast<double>(hasty.selected()) == doctest::Approx(static_cast<double>(after)).epsilon(0.05));
  CHECK(hasty.studio().history().entries().size() == patient.studio().history().entries().size());
}

TEST_CASE("nothing lost: what waits for a cut that fails is not done, and that is said") {
  Hands hands;
  Studio& studio = hands.studio();
  studio.apply(SetSmoothness{studio.document().active, std::numeric_limits<float>::quiet_NaN()});
  REQUIRE(studio.cuts().next() != 0);
  studio.apply(DeleteSelected{});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.cuts().failed() == 1);
  CHECK_FALSE(studio.document().deleted);
  CHECK(was_said(hands, "Delete from the scene: not done"));
  CHECK_FALSE(studio.waiting());
}

TEST_CASE("nothing lost: what is locked is not computed anew") {
  Hands hands;
  Studio& studio = hands.studio();
  studio.apply(LockObject{studio.document().active, true});
  const std::uint64_t cuts = studio.cuts().done();
  CHECK_FALSE(studio.why_not(Action::kRecompute).empty());
  studio.apply(Recompute{});
  REQUIRE(hands.app.settle());
  CHECK(studio.cuts().done() == cuts);
  CHECK(hands.said().find("is locked") != std::string::npos);
}

TEST_CASE("nothing lost: an export that waits for a cut is written before another scene is opened") {
  const ScratchFolder folder("waiting_export");
  Hands hands(false);
  click_at_once(hands, kOnApple);
  Export wanted;
  wanted.request.path = folder / "apple.ply";
  hands.studio().apply(wanted);
  hands.studio().apply(OpenScene{small_scene(folder)});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->cloud->size() == kAdded);
  REQUIRE(std::filesystem::exists(wanted.request.path));
  const std::size_t apple = load_scene(wanted.request.path).cloud.size();
  CHECK(apple > 0);
  CHECK(apple != kAdded);
}

TEST_CASE("nothing lost: an export asked for while another scene is opened is written, or said to be not") {
  const ScratchFolder folder("late_export");
  Hands hands(false);
  click_at_once(hands, kOnApple);
  hands.studio().apply(OpenScene{small_scene(folder)});
  Export wanted;
  wanted.request.path = folder / "apple.ply";
  hands.studio().apply(wanted);
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->cloud->size() == kAdded);
  CHECK((std::filesystem::exists(wanted.request.path) || was_said(hands, "Export: not done")));
}

TEST_CASE("nothing lost: commands that came while files changed are done") {
  const ScratchFolder folder("waiting_edits");
  Hands hands(false);
  Studio& studio = hands.studio();
  studio.apply(AddScene{small_scene(folder)});
  click_at_once(hands, kOnApple);
  studio.apply(EditSelection{SelectionEdit::kGrow});
  studio.apply(EditSelection{SelectionEdit::kInvert});
  REQUIRE(hands.app.frames_until([&] { return !studio.loading(); }));
  REQUIRE(studio.waiting());
  studio.apply(EditSelection{SelectionEdit::kShrink});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 2);
  for (const std::string title : {"Grow", "Invert", "Shrink"}) CHECK_MESSAGE(is_step(hands, title), title);
}

TEST_CASE("nothing lost: files that were being added are, where another scene is not opened after all") {
  const ScratchFolder folder("interrupted_files");
  Hands hands(false);
  Studio& studio = hands.studio();
  studio.apply(AddScene{small_scene(folder)});
  SUBCASE("as it cannot be read") {
    std::ofstream(folder / "none.ply") << "no scene";
    studio.apply(OpenScene{folder / "none.ply"});
  }
  SUBCASE("as that is stopped") {
    studio.apply(OpenScene{kSample});
    studio.apply(Cancel{});
  }
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 2);
}

TEST_CASE("nothing lost: Esc stops the first scene on its way") {
  HeadlessApp app(kHandsWidth, kHandsHeight);
  Studio& studio = app.studio();
  studio.apply(OpenScene{kSample});
  REQUIRE(studio.loading());
  studio.run(Action::kCancel);
  REQUIRE(app.settle());
  CHECK_FALSE(studio.scene());
  CHECK(studio.messages().back().text == "Cancelled");
  app.open(kSmallSample);
  REQUIRE(app.settle());
  CHECK(studio.scene());
}

TEST_CASE("nothing lost: saved work from which everything is removed is unsaved") {
  const ScratchFolder folder("emptied");
  Hands hands;
  Studio& studio = hands.studio();
  studio.apply(SaveWork{folder / "apple.splatcut.json"});
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.unsaved());
  studio.apply(RemoveObject{studio.document().active});
  REQUIRE(hands.app.settle());
  CHECK(studio.unsaved());
  studio.apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.unsaved());
}

TEST_CASE("nothing lost: a file that is moved before its click is cut takes the click along") {
  Hands patient(false), hasty(false);
  const auto labels = [](Hands& hands, bool waits) {
    Studio& studio = hands.studio();
    add(hands, kSmallSample);  // its twin
    const Camera here = studio.viewport().pane_camera();
    const glm::vec3 right = glm::transpose(here.camera_from_world_rotation)[0];
    const float size = studio.camera().scene_size();
    studio.apply(PlaceScene{last_file(hands).id, {3 * size * right, {0, 0, 0}, 1}});
    REQUIRE(hands.app.settle());
    studio.apply(GoToCamera{moved(here, {{1, 0, 0, 0}, 1, {0, 0, 0}, 3 * size * right})});
    REQUIRE(hands.app.settle());
    click_at_once(hands, kOnApple);
    if (waits) REQUIRE(hands.app.settle());
    studio.apply(PlaceScene{last_file(hands).id, {3.5f * size * right, {0, 90, 0}, 1}});
    REQUIRE(hands.app.settle());
    return active_by_row(studio);
  };
  const auto expected = labels(patient, true), found = labels(hasty, false);
  REQUIRE(count_flags(expected) > 0);
  CHECK(iou_of(found, expected) > 0.95);
}

TEST_CASE("nothing lost: and nothing is kept that no redo leads to") {
  const ScratchFolder folder("kept_scenes");
  Hands hands;
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  CHECK(studio.files().scenes_kept() == 1);
  studio.run(Action::kUndo);
  REQUIRE(hands.app.settle());
  CHECK(studio.files().scenes_kept() == 1);  // to redo
  studio.apply(EditSelection{SelectionEdit::kGrow});
  REQUIRE(hands.app.settle());
  CHECK(studio.files().scenes_kept() == 0);
}
