// Two dialogs that are wanted at once: one is shown, and the window stays alive.
#include <doctest/doctest.h>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr const char* kQuit = "###quit";
constexpr const char* kOpenAnyway = "###open_anyway";

// All is selected, so that there is unsaved work.
struct HandsWithWork : Hands {
  HandsWithWork() : Hands(false) {
    app.key('A', {.ctrl = true});
    REQUIRE(app.settle());
    REQUIRE(studio().unsaved_and_not_exported());
  }
};

bool shown(Hands& hands, const std::string& dialog) {
  return hands.app.window(dialog).size().x > 0;
}

void close_window(Hands& hands) {
  hands.studio().run(Action::kQuit);  // as its X does
}

void open_page(Hands& hands, const std::string& page) {
  if (page == "###help") hands.app.key(key::kF1);
  if (page == "###settings") hands.app.key(',', {.ctrl = true});
  if (page == "###export") hands.app.key('E', {.ctrl = true});
  if (page == "###turntable") hands.app.interface_state().turntable_open = true;
  if (page == "###files") hands.app.key('O', {.ctrl = true});
  hands.app.frames(3);
  REQUIRE(shown(hands, page));
}

}  // namespace

TEST_CASE("two dialogs: a question about unsaved work is seen at once, whatever dialog is open") {
  HandsWithWork hands;
  for (const std::string page : {"###help", "###settings", "###export", "###turntable", "###files"})
    for (const std::string question : {kQuit, kOpenAnyway}) {
      CAPTURE(page);
      CAPTURE(question);
      open_page(hands, page);
      if (question == kQuit)
        close_window(hands);
      else
        hands.app.open(kSmallSample);
      hands.app.frames(4);
      CHECK(shown(hands, question));
      CHECK_FALSE(shown(hands, page));
      hands.app.press_item(question, {"Stay"});
      hands.app.frames(3);
      CHECK_FALSE(shown(hands, question));
      const bool closes = page == "###help" || page == "###settings";
      CHECK(shown(hands, page) == !closes);  // what was being filled in comes back
      hands.app.key(key::kEscape);
      hands.app.frames(2);
      CHECK_FALSE(hands.app->interface().dialog_open());
      CHECK_FALSE(hands.app->wants_to_close());
    }
}

TEST_CASE("two dialogs: of what begins as no scene that is said at once, and the work stays") {
  const ScratchFolder folder("no_scene");
  HandsWithWork hands;
  const std::string text = "a list of things to buy\n";
  for (const char* name : {"notes.txt", "picture.png", "program.zip", "work.splatcut.json", "scene.splat"})
    std::ofstream(folder / name) << text;
  for (const char* name : {"notes.txt", "picture.png", "program.zip", "gone.ply"}) {
    CAPTURE(name);
    hands.app.open(folder / name);
    hands.app.frames(4);
    CHECK_FALSE(shown(hands, kOpenAnyway));
    REQUIRE(hands.app.settle());
    CHECK(hands.said().find(name) != std::string::npos);
    CHECK(hands.studio().unsaved_and_not_exported());
    CHECK(hands.studio().scene());
  }
  for (const char* name : {"work.splatcut.json", "scene.splat"}) {  // their beginning says nothing
    CAPTURE(name);
    hands.app.open(folder / name);
    hands.app.frames(4);
    CHECK(shown(hands, kOpenAnyway));
    hands.app.press_item(kOpenAnyway, {"Stay"});
    hands.app.frames(3);
  }
}

TEST_CASE("two dialogs: leaving is asked before opening, and each answer counts") {
  HandsWithWork hands;
  hands.app.open(kSmallSample);
  hands.app.frames(3);
  close_window(hands);
  hands.app.frames(3);
  REQUIRE(shown(hands, kQuit));
  hands.app.press_item(kQuit, {"Stay"});
  hands.app.frames(2);
  REQUIRE(shown(hands, kOpenAnyway));
  hands.app.press_item(kOpenAnyway, {"Stay"});
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  close_window(hands);
  hands.app.frames(3);
  hands.app.press_item(kQuit, {"Leave"});
  CHECK(hands.app->wants_to_close());
}

TEST_CASE("two dialogs: one that nobody asked for just now waits until the other is closed") {
  HandsWithWork hands;
  open_page(hands, "###help");
  hands.app.interface_state().export_open = true;  // as of an export that failed meanwhile
  hands.app.frames(4);
  CHECK(shown(hands, "###help"));
  CHECK_FALSE(shown(hands, "###export"));
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  CHECK_FALSE(shown(hands, "###help"));
  CHECK(shown(hands, "###export"));
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
}

TEST_CASE("two dialogs: a question about a file is not asked of another file") {
  const ScratchFolder folder("two_dialogs");
  std::ofstream(folder / "there.png") << "kept";
  HandsWithWork hands;
  hands.app.key(key::kF12);
  hands.app.interface_state().files.folder = folder.path();
  hands.app.interface_state().files.name = "there.png";
  hands.app.key(key::kEnter);
  hands.app.frames(3);
  REQUIRE(shown(hands, "###replace"));
  close_window(hands);
  hands.app.frames(3);
  hands.app.press_item(kQuit, {"Save..."});
  hands.app.frames(3);
  REQUIRE(shown(hands, "###files"));
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  CHECK_FALSE(hands.app->interface().dialog_open());
}

TEST_CASE("two dialogs: an open menu closes for a question") {
  HandsWithWork hands;
  hands.app->interface().make_current();
  hands.app.press_item("bar", {icon::kDown});
  hands.app.frames(2);
  REQUIRE(hands.app->interface().dialog_open());
  close_window(hands);
  hands.app.frames(3);
  CHECK(shown(hands, kQuit));
}
