// The desktop's own dialogs for files (a stand-in of them), and the built-in one in their place.
#include <doctest/doctest.h>

#include <sys/wait.h>

#include <filesystem>
#include <string>

#include "headless_app.h"
#include "only_path.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The desktop's dialog is the only child of this process. Its end is left to the program to meet.
void wait_for_answer(HeadlessApp& app) {
  siginfo_t ended;
  ::waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT);  // no child: it was met already
  app.frames(3);
  REQUIRE(app.settle());
}

}  // namespace

TEST_CASE("dialogs: zenity's answer opens the scene, kdialog's too, and it is asked for the right thing") {
  for (const std::string program : {"zenity", "kdialog"}) {
    CAPTURE(program);
    const ScratchFolder folder("native_" + program);
    const OnlyPath path(folder.path());
    path.put(program, "echo '" + kSmallSample.string() + "'");
    HeadlessApp app(760, 420);
    app.interface_state().native_wanted = true;
    app.key('O', {.ctrl = true});
    wait_for_answer(app);
    CHECK_FALSE(app->interface().dialog_open());
    REQUIRE(app.settle());
    REQUIRE(app.studio().scene());
    CHECK(app.studio().scene()->scene->path == kSmallSample);
    CHECK(path.asked().find(program) != std::string::npos);
    CHECK(path.asked().find("*.splatcut.json") != std::string::npos);
  }
}

TEST_CASE("dialogs: work is saved where the desktop's dialog says, with the ending it needs") {
  const ScratchFolder folder("native_save");
  HeadlessApp app(760, 420);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const OnlyPath path(folder.path());
  path.put("zenity", "echo '" + (folder / "mine").string() + "'");
  app.interface_state().native_wanted = true;
  app.key('S', {.ctrl = true});
  wait_for_answer(app);
  CHECK(std::filesystem::exists(folder / "mine.splatcut.json"));
  CHECK(path.asked().find("--save\n") != std::string::npos);
}

TEST_CASE(
    "dialogs: a cancelled one changes nothing; one that fails, and none at all, give the built-in one") {
  const ScratchFolder folder("native_none");
  const OnlyPath path(folder.path());
  HeadlessApp app(760, 420);
  app.interface_state().native_wanted = true;
  path.put("zenity", "exit 1");
  app.key('O', {.ctrl = true});
  wait_for_answer(app);
  CHECK_FALSE(app->interface().dialog_open());
  CHECK_FALSE(app.studio().scene());
  path.put("zenity", "exit 255");
  app.key('O', {.ctrl = true});
  wait_for_answer(app);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  app.frames(2);
  CHECK_FALSE(app->interface().dialog_open());
  std::filesystem::remove(folder / "zenity");
  app.key('O', {.ctrl = true});
  app.frames(2);
  CHECK(app->interface().dialog_open());
}
