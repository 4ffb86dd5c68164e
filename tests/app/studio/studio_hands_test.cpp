// What artists' hands know from other tools: keys, dialogs, the history, words.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "app/document/words.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: numbers are written one way, lengths with three figures") {
  CHECK(grouped(999) == "999");
  CHECK(grouped(92440) == "92,440");
  CHECK(grouped(1234567) == "1,234,567");
  CHECK(length_text(0) == "0");
  CHECK(length_text(0.0235f) == "0.0235");
  CHECK(length_text(12.4f) == "12.4");
  CHECK(length_text(1250.4f) == "1,250");
  CHECK(scene_name("a/garden.ply") == "garden.ply");
  CHECK(scene_name("a/garden/meta.json") == "garden");
  CHECK(scene_name("a/garden/lod-meta.json") == "garden");
  CHECK(scene_name("a/garden/") == "garden");
  CHECK(scene_name("meta.json") == std::filesystem::current_path().filename());
  Hands hands(false);
  CHECK(std::ranges::any_of(hands.studio().messages(), [](const Message& m) {
    return m.text.find("3,000") != std::string::npos && m.text.find("Gaussians") != std::string::npos;
  }));
  hands.app.key('A', {.ctrl = true});
  CHECK(hands.said().find("3,000") != std::string::npos);
}

TEST_CASE("hands: a held bracket key changes the brush no more than threefold in a second") {
  Hands hands(false);
  hands.app.key('5');
  const float before = hands.studio().view().brush_px;
  hands.app->handle(KeyChanged{']', true, false, {}});
  for (int i = 0; i < 60; ++i) {
    hands.app.frames(1);
    hands.app->handle(KeyChanged{']', true, true, {}});
  }
  hands.app->handle(KeyChanged{']', false, false, {}});
  CHECK(hands.studio().view().brush_px > 1.5f * before);
  CHECK(hands.studio().view().brush_px < 3 * before);
}

TEST_CASE("hands: a new scene begins with the click tool, an ordinary brush and the whole scene") {
  Hands hands;
  ViewState view = hands.studio().view();
  view.tool = Tool::kBrush;
  view.operation = SetOperation::kRemove;
  view.brush_px = kMostBrushPx;
  hands.studio().apply(SetView{view});
  hands.studio().apply(OpenScene{kSmallSample});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().view().tool == Tool::kClick);
  CHECK(hands.studio().view().operation == SetOperation::kAdd);
  CHECK(hands.studio().view().brush_px <= kMostKeptBrushPx);
}

TEST_CASE("hands: a click at the moment when a scene opens is cut") {
  HeadlessApp app(kHandsWidth, kHandsHeight);
  app.frames(1);
  app.open(kSmallSample);
  while (!app.studio().scene()) app.studio().update(1.0 / 60);
  app.studio().apply(
      AddStroke{app.studio().viewport().pane_camera(),
                click(app.screen_of(kOnApple) - app->interface().viewport().min, SeedLabel::kObject)});
  REQUIRE(app.settle());
  CHECK(app.studio().gaussians_of(app.studio().document().active) > 20);
}

TEST_CASE("hands: thumbnails follow the history") {
  Hands hands;
  const auto serials = [&] {
    std::vector<std::uint64_t> out;
    const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
    if (run)
      for (const ViewCard& card : run->views) out.push_back(card.serial);
    return out;
  };
  const auto first = serials();
  REQUIRE(first.size() > 1);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto second = serials();
  REQUIRE(second.size() > 1);
  CHECK(second != first);
  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(serials() == first);
  hands.app.key('Z', {.shift = true, .ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(serials() == second);
  hands.studio().apply(JumpHistory{0});
  REQUIRE(hands.app.settle());
  CHECK(serials().empty());
}

TEST_CASE("hands: undone or cancelled while it is cut, the cut before is on show again") {
  for (const bool cancelled : {false, true}) {
    CAPTURE(cancelled);
    Hands hands;
    const ObjectId apple = hands.studio().document().active;
    const auto result = hands.studio().cuts().run(apple)->result;
    REQUIRE(result);
    hands.studio().apply(
        AddStroke{hands.studio().viewport().pane_camera(),
                  click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
    hands.studio().update(1.0 / 60);
    REQUIRE(hands.studio().cutting());
    hands.studio().apply(cancelled ? Command(Cancel{}) : Undo{});
    REQUIRE(hands.app.settle());
    REQUIRE(hands.studio().cuts().run(apple));
    CHECK(hands.studio().cuts().run(apple)->result == result);
    CHECK_FALSE(hands.studio().cuts().run(apple)->views.empty());
  }
}

TEST_CASE("hands: Alt+click where the preset has no parts says why it does nothing") {
  Hands hands;
  hands.studio().apply(SetPreset{"paper"});
  const std::size_t before = hands.studio().messages().size();
  hands.studio().apply(
      IntersectStroke{hands.studio().viewport().pane_camera(),
                      click(hands.in_viewport(hands.app.screen_of(kOnOrange)), SeedLabel::kObject)});
  REQUIRE(hands.app.settle());
  CHECK(std::any_of(hands.studio().messages().begin() + static_cast<std::ptrdiff_t>(before),
                    hands.studio().messages().end(),
                    [](const Message& m) { return m.kind == Message::Kind::kRefused; }));
  hands.studio().apply(IntersectStroke{hands.studio().viewport().pane_camera(), {}});
  CHECK(hands.studio().messages().back().kind == Message::Kind::kRefused);
}

TEST_CASE("hands: with everything undone the whole scene is shown, not an empty object alone") {
  Hands hands;
  hands.app.key('I');
  REQUIRE(hands.studio().view().display == DisplayMode::kIsolate);
  hands.studio().apply(JumpHistory{0});
  hands.app.frames(2);
  CHECK(hands.studio().view().display == DisplayMode::kWhole);
}

TEST_CASE("hands: Esc closes a menu before it changes the tool") {
  Hands hands(false);
  hands.app.key('5');
  hands.app.click({kHandsWidth - 316 + 289, 0});  // nothing there
  hands.app.interface_state().recent = {kSmallSample};
  hands.app.frames(2);
  hands.app.press_item("bar", {icon::kDown});
  REQUIRE(hands.app->interface().dialog_open());
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  CHECK(hands.studio().view().tool == Tool::kBrush);
  hands.app.key(key::kEscape);
  CHECK(hands.studio().view().tool == Tool::kNavigate);
}

TEST_CASE("hands: Enter saves work where a scene would be opened over it, and discards nothing") {
  Hands hands;
  const std::uint64_t serial = hands.studio().scene()->serial;
  hands.app.open(kSmallSample);
  hands.app.frames(3);
  REQUIRE(hands.app->interface().dialog_open());
  hands.app.key(key::kEnter);
  hands.app.frames(3);
  CHECK(hands.app->interface().dialog_open());  // where to save
  CHECK(hands.app.interface_state().files.saving);
  hands.app.key(key::kEscape);
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->serial == serial);
}

TEST_CASE("hands: a file is found by its first letters, by arrows, and opened by Enter") {
  const ScratchFolder folder("browse");
  std::filesystem::create_directories(folder / "garden");
  for (const char* name : {"alpha.ply", "beta.ply", "bicycle.ply"}) std::ofstream(folder / name) << "x";
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = folder.path();
  app.key('O', {.ctrl = true});
  app.frames(2);
  REQUIRE(files.open);
  REQUIRE(files.entries.size() == 4);
  const auto type = [&](char letter) {
    app->handle(TextTyped{static_cast<unsigned>(letter)});
    app.frames(1);
  };
  type('b');
  CHECK(files.name == "beta.ply");
  type('i');
  CHECK(files.name == "bicycle.ply");
  app.key(key::kUp);
  CHECK(files.name == "beta.ply");
  app.key(key::kHome);
  CHECK(files.cursor == 0);
  app.key(key::kEnter);  // the folder
  app.frames(2);
  REQUIRE(files.entries.size() == 1);
  app.key(key::kDown);
  CHECK(files.name == "mug.compressed.ply");
  app.key(key::kEnter);
  CHECK_FALSE(files.open);
  REQUIRE(app.settle());
  CHECK(app.studio().scene() != nullptr);
}

TEST_CASE("hands: two presses are a double-click by their own times, however slow the frames") {
  Hands hands(false);
  hands.app.key('1');
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  const auto distance = [&] { return hands.studio().camera().pose().distance; };
  const auto two = [&](double apart_s) {
    hands.app.move(at);
    for (const double t : {100.0, 100.0 + apart_s}) {
      hands.app->handle(PointerButtonChanged{PointerButton::kLeft, true, {}, t});
      hands.app->frame(0.6);  // slower than any hand
      hands.app->handle(PointerButtonChanged{PointerButton::kLeft, false, {}, t + 0.05});
      hands.app->frame(0.6);
    }
    REQUIRE(hands.app.settle());
  };
  const float before = distance();
  two(0.8);
  CHECK(distance() == before);
  two(0.2);
  CHECK(distance() != before);
}

TEST_CASE("hands: floaters are shown as long as there are any") {
  HeadlessApp app;
  REQUIRE(cut_out_apple(app));
  Studio& studio = app.studio();
  studio.apply(EditSelection{SelectionEdit::kRemoveFloaters});
  REQUIRE(app.settle());
  studio.apply(ShowFloaters{true});
  REQUIRE(app.settle());
  CHECK_FALSE(studio.viewport().floaters_shown());
  CHECK(studio.messages().back().text == "Nothing floats apart from the object");
  // A few Gaussians of the lamp's shade, far from the apple.
  const std::vector<std::uint8_t> lamp = sample_truth(*studio.scene()->scene, 5);
  const std::size_t of_lamp = static_cast<std::size_t>(std::ranges::find(lamp, 1) - lamp.begin());
  REQUIRE(of_lamp < lamp.size());
  const glm::vec3 there = studio.scene()->cloud->position[of_lamp];
  studio.apply(SelectVolume{{true, there, glm::vec3(0.01f)}, SetOperation::kAdd, false});
  REQUIRE(app.settle());
  studio.apply(ShowFloaters{true});
  REQUIRE(app.settle());
  CHECK(studio.viewport().floaters_shown());
  CHECK(studio.viewport().floater_count() > 0);
  studio.apply(EditSelection{SelectionEdit::kRemoveFloaters});
  REQUIRE(app.settle());
  CHECK_FALSE(studio.viewport().floaters_shown());
}

TEST_CASE("hands: a click soon after the display changed is judged in the picture that will show it") {
  Hands hands = hands_on_sample();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const std::size_t before = hands.selected();
  hands.app.key('I');  // back to the scene; the apple alone is still on the screen
  hands.app.move(hands.app.screen_of(kOnOrange));
  hands.app.press(PointerButton::kLeft);
  hands.app.release(PointerButton::kLeft);
  CHECK(hands.selected() > before);
  CHECK(hands.studio().document().active_object()->views.front().strokes.size() == 2);
  CHECK(hands.said().find("nothing in that place") == std::string::npos);
}

TEST_CASE("hands: a click that changes nothing is a warning, with what to do") {
  Hands hands;
  const std::size_t before = hands.selected();
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.selected() == before);
  const Message& last = hands.studio().messages().back();
  CHECK(last.kind == Message::Kind::kRefused);
  CHECK(last.text.find("changed nothing") != std::string::npos);
}

TEST_CASE(
    "hands: right after a click + and - step its sizes, as the badges say, and Ctrl grows and shrinks") {
  CHECK(action_for('=', {}) == Action::kPartLarger);
  CHECK(action_for('=', {.shift = true}) == Action::kPartLarger);  // + on many keyboards
  CHECK(action_for('-', {}) == Action::kPartSmaller);
  CHECK(action_for('=', {.ctrl = true}) == Action::kGrow);
  CHECK(action_for('=', {.shift = true, .ctrl = true}) == Action::kGrow);
  CHECK(action_for('-', {.ctrl = true}) == Action::kShrink);
  Hands hands = hands_on_sample();
  const std::size_t apple = hands.selected();
  hands.app.key('=', {.shift = true});
  CHECK(hands.selected() > apple);
  CHECK(hands.studio().document().active_object()->part_step == 1);
  hands.app.key('-');
  CHECK(hands.selected() == apple);
}

TEST_CASE("hands: an object's colour is one that shows on what was clicked, and stays") {
  Hands hands = hands_on_sample(false);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const Rgb8 on_orange = hands.studio().document().active_object()->colour;
  CHECK(on_orange[2] > on_orange[0]);  // bluish; an object's first colour is orange
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().document().active_object()->colour == on_orange);
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().document().active_object()->colour != on_orange);
}

TEST_CASE("hands: a path is typed as soon as the dialog is open, and Enter opens it") {
  const ScratchFolder folder("typed_path");
  std::filesystem::create_directories(folder / "garden");
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  const auto type = [&](const std::string& text) {
    for (const char letter : text) {
      app->handle(TextTyped{static_cast<unsigned>(letter)});
      app.frames(1);
    }
  };
  for (const bool whole : {true, false}) {
    CAPTURE(whole);
    files.folder = whole ? std::filesystem::temp_directory_path() : folder.path();
    app.key('O', {.ctrl = true});
    app.frames(3);
    REQUIRE(files.open);
    if (whole) {
      type((folder / "garden").string());
      app.key(key::kEnter);
      app.frames(3);
      REQUIRE(files.open);
      CHECK(files.folder.filename() == "garden");
      type("mu");  // the beginning of a name
      CHECK(files.name == "mug.compressed.ply");
    } else {
      type("garden/mug.compressed.ply");  // from the folder that is shown
    }
    const std::uint64_t before = app.studio().scene() ? app.studio().scene()->serial : 0;
    app.key(key::kEnter);
    CHECK_FALSE(files.open);
    REQUIRE(app.settle());
    REQUIRE(app.studio().scene());
    CHECK(app.studio().scene()->serial != before);
  }
}

TEST_CASE("hands: a whole path is completed as a name is") {
  const ScratchFolder folder("whole_path");
  std::filesystem::create_directories(folder / "garden");
  std::filesystem::copy_file(kSmallSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = std::filesystem::current_path();
  app.key('O', {.ctrl = true});
  app.frames(3);
  for (const char letter : (folder / "gar").string()) {
    app->handle(TextTyped{static_cast<unsigned>(letter)});
    app.frames(1);
  }
  CHECK(std::filesystem::equivalent(files.folder, folder.path()));
  REQUIRE(files.cursor >= 0);
  CHECK(files.entries[static_cast<std::size_t>(files.cursor)].name == "garden");
  for (const char letter : std::string("den/mu")) {
    app->handle(TextTyped{static_cast<unsigned>(letter)});
    app.frames(1);
  }
  CHECK(files.typed_folder == (folder / "garden" / "mu").string());
  CHECK(files.name == "mug.compressed.ply");
  app.key(key::kEnter);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
}

TEST_CASE("hands: Tab goes from the path to the list of files, and Enter opens what it marks") {
  const ScratchFolder folder("tab_to_list");
  for (const char* name : {"alpha.compressed.ply", "beta.compressed.ply"})
    std::filesystem::copy_file(kSmallSample, folder / name);
  HeadlessApp app(kHandsWidth, kHandsHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = folder.path();
  app.key('O', {.ctrl = true});
  app.frames(3);
  for (int i = 0; i < 2; ++i) {
    app.key(key::kTab);
    app.frames(20);
  }
  app.key(key::kEnter);
  app.frames(3);
  CHECK_FALSE(files.open);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  CHECK(app.studio().scene()->scene->path.filename() == "beta.compressed.ply");
}

TEST_CASE("hands: a new object leaves to the others what they have, unless it is clicked on that") {
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = studio.labels(studio.document().active);
  const glm::vec2 middle = hands.in_viewport(hands.app.screen_of(kOnApple));
  ViewState view = studio.view();
  view.see_through = true;
  studio.apply(SetView{view});
  const Camera camera = studio.viewport().pane_camera();
  studio.apply(SelectRegion{
      camera, rectangle_region({0, 0}, {middle.x, camera.height_px}, camera.width_px, camera.height_px),
      SetOperation::kIntersect});
  REQUIRE(hands.app.settle());
  const auto left_half = studio.labels(1);
  REQUIRE(count_flags(left_half) > 0);
  const auto shared = [&](ObjectId object) {
    const auto labels = studio.labels(object);
    std::size_t both = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) both += labels[g] && left_half[g];
    return both;
  };
  const auto click_new = [&](float aside) {
    studio.apply(NewObject{});
    hands.app.click(hands.app.screen_of(kOnApple) + glm::vec2(aside, 0));
    REQUIRE(hands.app.settle());
    return studio.document().active;
  };
  const ObjectId right = click_new(14);
  CHECK(shared(right) == 0);
  CHECK(hands.selected() > 0);
  CHECK(std::ranges::any_of(studio.messages(), [](const Message& m) {
    return m.text.find("Object 1 keeps") != std::string::npos;
  }));
  const ScratchFolder folder("of_others");
  studio.apply(SaveWork{folder / "two.splatcut.json"});
  REQUIRE(hands.app.settle());
  Hands other(false);
  other.app.open(folder / "two.splatcut.json");
  REQUIRE(other.app.settle());
  CHECK(other.studio().labels(right) == studio.labels(right));

  studio.apply(LeaveToOthers{right, false});
  REQUIRE(hands.app.settle());
  CHECK(iou_of(studio.labels(right), apple) > 0.95);
  studio.apply(LeaveToOthers{right, true});
  REQUIRE(hands.app.settle());
  CHECK(shared(right) == 0);
  CHECK(studio.labels(1) == left_half);

  studio.apply(RemoveObject{right});
  float on_left = 0;  // where the first object shows
  for (float aside = -2; aside > -40 && on_left == 0; --aside)
    if (const auto hit = studio.viewport().pick(middle + glm::vec2(aside, 0));
        hit && left_half[static_cast<std::size_t>(hit->gaussian)])
      on_left = aside;
  REQUIRE(on_left != 0);
  const ObjectId on_it = click_new(on_left);
  CHECK(shared(on_it) > count_flags(left_half) / 2);
}

TEST_CASE("hands: keys that need the object wait for its first cut, the last of a kind") {
  Hands hands(false);
  Studio& studio = hands.studio();
  const auto click = [&](const glm::vec2& at) {
    studio.apply(AddStroke{studio.viewport().pane_camera(),
                           {SeedLabel::kObject, 4, {hands.in_viewport(hands.app.screen_of(at))}}});
  };
  const CameraPose pose = studio.camera().pose();
  click(kOnApple);
  studio.run(Action::kHide);
  studio.run(Action::kIsolate);
  studio.run(Action::kFrameObject);
  CHECK(studio.view().display == DisplayMode::kWhole);
  REQUIRE(hands.app.settle());
  CHECK(studio.view().display == DisplayMode::kIsolate);
  CHECK_FALSE(studio.camera().pose() == pose);

  studio.apply(SetView{});
  studio.apply(GoToCamera{studio.scene()->views().reference});
  studio.apply(NewObject{});
  REQUIRE(hands.app.settle());
  click(kOnMug);
  studio.run(Action::kFrameObject);
  studio.camera().orbit({20, 0});  // another view is wanted now
  const CameraPose turned = studio.camera().pose();
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() > 0);
  CHECK(studio.camera().pose() == turned);

  studio.apply(GoToCamera{studio.scene()->views().reference});
  studio.apply(NewObject{});
  REQUIRE(hands.app.settle());
  click(kOnOrange);
  studio.run(Action::kHide);
  click(kOnOrange + glm::vec2(6, 0));  // another click drops it
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() > 0);
  CHECK(studio.view().display == DisplayMode::kWhole);
  studio.apply(NewObject{});
  click(kOnMug);
  studio.run(Action::kHide);
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK(studio.view().display == DisplayMode::kWhole);
}

TEST_CASE("hands: no two objects have one colour while others are free") {
  Hands hands(false);
  Studio& studio = hands.studio();
  const auto colours = [&] {
    std::set<Rgb8> all;
    for (const ObjectItem& object : studio.document().objects) all.insert(object.colour);
    return all.size();
  };
  studio.apply(NewObject{});
  studio.apply(NewObject{});
  const ObjectItem second = studio.document().objects.back();
  studio.apply(Undo{});
  studio.apply(RecolourObject{studio.document().objects.front().id, second.colour});
  for (std::size_t objects = 2; objects <= 8; ++objects) {
    studio.apply(NewObject{});
    CHECK(studio.document().objects.size() == objects);
    CHECK(colours() == objects);
  }
  studio.apply(NewObject{});  // there are eight
  CHECK(colours() == 8);
}

TEST_CASE("hands: Enter by the way is told what it is for, and all that Ctrl+A takes is counted") {
  Hands hands;
  hands.app.key(key::kEnter);
  CHECK(hands.said().find("press an arrow first") != std::string::npos);
  CHECK(hands.said().find("polygon") == std::string::npos);
  CHECK(hands.studio().messages().back().kind == Message::Kind::kInfo);
  hands.app.key('A', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.said() == "All " + gaussians_text(hands.studio().scene()->cloud->size()) +
                            " are selected. Ctrl+Z takes it back");
}
