// The whole program while its threads work, on a scene small enough for the thread sanitizer: what is asked
// for in haste must come out as if every step had been waited for.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "app/console/output_folder.h"
#include "app/measure/still_life_files.h"
#include "app/workspace/task_thread.h"
#include "core/error.h"
#include "headless_app.h"
#include "quick.h"
#include "scene/still_life/still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kWidth = 480, kHeight = 320;

// Two small still lifes on disk.
struct TwoScenes {
  ScratchFolder folder{"in_haste"};
  LabelledScene life;

  TwoScenes() {
    StillLifeOptions options;
    options.gaussians = 1500;
    life = make_still_life(options);
    for (const char* name : {"one", "two"}) {
      OutputFolder out(folder / name, false);
      write_still_life(out, life, name, "ply");
      out.commit();
    }
  }

  std::filesystem::path one() const { return folder / "one/one.ply"; }
  std::filesystem::path two() const { return folder / "two/two.ply"; }

  AddStroke click_on(const std::string& object) const {
    const auto seed = std::ranges::find(life.seeds, object, &LabelledScene::SeedClick::object);
    return {life.cameras.at(static_cast<std::size_t>(seed->camera)), click(seed->pixel, SeedLabel::kObject)};
  }
  AddStroke not_this(const std::string& object) const {
    AddStroke stroke = click_on(object);
    stroke.stroke.label = SeedLabel::kRest;
    return stroke;
  }
};

// As many frames as a hasty hand leaves, with the pointer and the view on the move.
void a_moment(HeadlessApp& app, int frames) {
  const UiRect view = app->interface().viewport();
  for (int i = 0; i < frames; ++i) {
    app.move(view.min + 0.1f * static_cast<float>(1 + (7 * i) % 8) * view.size());
    app.studio().camera().orbit({4, 1});
    app.frames(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
}

}  // namespace

TEST_CASE(
    "threads: strokes, undo, smoothness and another object, all in haste, leave the same work as one after "
    "the other") {
  const TwoScenes scenes;
  const auto work_after = [&](bool haste) {
    HeadlessApp app(kWidth, kHeight, 1, {});
    app.open(scenes.one());
    REQUIRE(app.settle());
    int step = 0;
    const auto then = [&](const auto& command) {
      app.studio().apply(command);
      if (haste)
        a_moment(app, 1 + step++ % 4);
      else
        REQUIRE(app.settle());
    };
    const auto active = [&] { return app.studio().document().active; };
    then(scenes.click_on("mug"));
    then(Cancel{});
    then(Recompute{});
    then(scenes.not_this("apple"));
    then(Undo{});
    then(Redo{});
    then(SetSmoothness{active(), 3.0f});
    then(SetSmoothness{active(), 4.0f});
    then(NewObject{});
    then(scenes.click_on("plant"));
    then(scenes.not_this("books"));
    then(Undo{});
    REQUIRE(app.settle());
    CHECK(app.studio().document().objects.size() == 2);
    for (const ObjectItem& object : app.studio().document().objects)
      CHECK(app.studio().gaussians_of(object.id) > 0);
    return Document(app.studio().document());
  };
  CHECK(same(work_after(true), work_after(false)));
}

QUICK_CASE("task thread", "threads: exports wait for each other, of any other kind the latest request wins") {
  std::atomic<bool> go = false;
  std::vector<std::string> done;
  TaskThread tasks;
  const auto submit = [&](TaskKind kind, const std::string& name) {
    tasks.submit(kind, [&, name](const Job& job) {
      go.wait(false);
      tasks.post([&, text = name + (job.cancelled() ? " stopped" : " done")] { done.push_back(text); });
    });
  };
  submit(TaskKind::kExport, "turntable");
  submit(TaskKind::kAutosave, "first autosave");
  submit(TaskKind::kExport, "snapshot");
  submit(TaskKind::kCut, "first cut");
  submit(TaskKind::kAutosave, "second autosave");
  submit(TaskKind::kCut, "second cut");
  go = true;
  go.notify_all();
  while (!tasks.idle()) {
    tasks.deliver();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(done == std::vector<std::string>{"turntable done", "snapshot done", "second autosave done",
                                         "second cut done"});
}

QUICK_CASE("task thread",
           "threads: what the program does by itself says what it does, and is nobody's business") {
  for (const TaskKind kind : {TaskKind::kHover, TaskKind::kReady, TaskKind::kAhead, TaskKind::kCut}) {
    std::atomic<bool> reported = false, go = false;
    TaskThread tasks;
    tasks.submit(kind, [&](const Job& job) {
      job.progress("superpoints", 0.5);
      reported = true;
      reported.notify_all();
      go.wait(false);
    });
    reported.wait(false);
    const TaskThread::Progress progress = tasks.progress();
    CHECK(progress.busy == (kind == TaskKind::kCut));
    CHECK(progress.kind == kind);
    CHECK(progress.stage == "superpoints");
    go = true;
    go.notify_all();
  }
}

QUICK_CASE("task thread",
           "threads: trouble is told to the task it befell, and to nobody where that was replaced") {
  std::atomic<bool> go = false;
  std::vector<std::string> told, shown;
  TaskThread tasks;
  tasks.on_error = [&](const std::string& message) { shown.push_back(message); };
  const auto fail = [&](TaskKind kind, const std::string& name) {
    tasks.submit({kind, [&, name] { told.push_back(name); }}, [&, name](const Job&) {
      go.wait(false);
      throw Error(name, "failed");
    });
  };
  fail(TaskKind::kCut, "replaced");
  while (!tasks.progress().busy) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  fail(TaskKind::kCut, "cut");
  fail(TaskKind::kPrepare, "preparing");
  go = true;
  go.notify_all();
  while (!tasks.idle()) {
    tasks.deliver();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(told == std::vector<std::string>{"cut", "preparing"});
  CHECK(shown == std::vector<std::string>{"cut: failed.", "preparing: failed."});
}

QUICK_CASE("task thread",
           "threads: the end of the program waits for work that is being saved, and for nothing else") {
  std::vector<std::string> done;
  std::atomic<bool> running = false;
  {
    TaskThread tasks;
    tasks.submit(TaskKind::kCut, [&](const Job& job) {
      running = true;
      running.notify_all();
      while (!job.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    tasks.submit(TaskKind::kSave, [&](const Job&) { done.push_back("first save"); });
    tasks.submit(TaskKind::kExport, [&](const Job&) { done.push_back("export"); });
    tasks.submit(TaskKind::kSave, [&](const Job&) { done.push_back("second save"); });
    running.wait(false);
  }
  CHECK(done == std::vector<std::string>{"first save", "second save"});
}

TEST_CASE("threads: another scene is opened while the first is read, prepared and cut") {
  const TwoScenes scenes;
  HeadlessApp app(kWidth, kHeight, 1, {});
  for (const int frames : {1, 6}) {
    CAPTURE(frames);
    app.studio().apply(OpenScene{scenes.one()});
    a_moment(app, frames);
    app.studio().apply(OpenScene{scenes.two()});
    REQUIRE(app.settle());
    REQUIRE(app.studio().scene()->scene->path == scenes.two());
    app.studio().apply(scenes.click_on("apple"));
    a_moment(app, frames);
    app.studio().apply(OpenScene{scenes.one()});
    REQUIRE(app.settle());
    CHECK(app.studio().scene()->scene->path == scenes.one());
    CHECK(app.studio().document().objects.empty());
    CHECK_FALSE(app.studio().cutting());
  }
}

TEST_CASE("threads: files are written, pictures taken and views switched while a cut runs") {
  const TwoScenes scenes;
  const auto in = [&](const char* name) { return scenes.folder / name; };
  HeadlessApp app(kWidth, kHeight, 1, {});
  app.open(scenes.one());
  REQUIRE(app.settle());
  app.studio().apply(scenes.click_on("apple"));
  REQUIRE(app.settle());
  const std::size_t gaussians = app.studio().gaussians_of(app.studio().document().active);
  REQUIRE(gaussians > 0);
  ViewState view;
  view.display = DisplayMode::kSideBySide;
  view.heat = true;
  app.studio().apply(SetView{view});
  app.studio().apply(scenes.not_this("books"));
  app.studio().apply(SaveTurntable{in("turn"), 3, 64, 48});
  a_moment(app, 3);
  app.studio().apply(SaveWork{in("apple.splatcut.json")});
  app.studio().apply(SaveSnapshot{in("apple.png"), true});
  a_moment(app, 2);
  REQUIRE(app.settle());
  app.studio().apply(scenes.click_on("apple"));
  app.studio().apply(Export{{ExportWhat::kAllObjects, SceneFormat::kPly, in("parts"), true}});
  view.display = DisplayMode::kIsolate;
  app.studio().apply(SetView{view});
  REQUIRE(app.settle());
  for (const char* name : {"turn/frame_0002.png", "apple.splatcut.json", "apple.png", "parts"}) {
    CAPTURE(name);
    CHECK(std::filesystem::exists(in(name)));
  }
  app.studio().apply(SaveTurntable{in("too many"), 5000, 64, 48});
  a_moment(app, 2);
  app.studio().apply(Cancel{});
  REQUIRE(app.settle());
  CHECK_FALSE(std::filesystem::exists(in("too many")));
  app.studio().apply(scenes.click_on("mug"));  // and an end in the middle of it
  app.frames(1);
}
