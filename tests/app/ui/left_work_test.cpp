// The list of work that crashes left: what tells one from another, and when it comes.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/document/words.h"
#include "app/work/work_file.h"
#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Of a scene that trainers name as they name all.
void leave_work(const ScratchFolder& folder, const std::string& capture, const std::string& file) {
  const std::filesystem::path scene =
      folder / (capture + "/point_cloud/iteration_30000/point_cloud.compressed.ply");
  std::filesystem::create_directories(scene.parent_path());
  std::filesystem::copy_file(kSmallSample, scene, std::filesystem::copy_options::skip_existing);
  Document document;
  add_object(&document, "mug");
  write_work_file(folder / file, *open_scene(scene), document);
}

}  // namespace

TEST_CASE("left work: scenes whose files trainers name alike are told apart by their folders") {
  CHECK(name_in_folder("/a/garden/point_cloud/iteration_7000/point_cloud.ply") ==
        "garden/iteration_7000/point_cloud.ply");
  CHECK(name_in_folder("/a/garden/point_cloud/point_cloud.ply") == "garden/point_cloud.ply");
  CHECK(name_in_folder("/a/garden/meta.json") == "garden");
  CHECK(name_in_folder("/a/garden/room.ply") == "garden/room.ply");
  const ScratchFolder folder("left_alike");
  leave_work(folder, "a_garden_with_a_long_name", "autosave.splatcut.json");
  leave_work(folder, "fox", "autosave.2.splatcut.json");
  HeadlessApp app(640, 480, 1, with_state(folder));
  app.frames(3);
  CHECK(app.button("\na_garden_with_a_long_name").size().x > 0);
  CHECK(app.button("\nfox").size().x > 0);
}

TEST_CASE("left work: the start page shows the three newest, the rest behind a row that ends within it") {
  const ScratchFolder folder("left_many");
  for (int i = 2; i < 9; ++i) leave_work(folder, "fox", fmt::format("autosave.{}.splatcut.json", i));
  HeadlessApp app(480, 480, 1, with_state(folder));
  app.frames(3);
  REQUIRE(app.studio().work().offers().size() == 7);
  const auto rows = [&] {
    return std::ranges::count_if(app.interface_state().items, [](const ShownItem& i) {
      return i.name.find("\nfox") != std::string::npos;
    });
  };
  CHECK(rows() == 3);
  CHECK(app.button("4 more").size().x > 0);
  app.press_item("/start", {"###older"});
  app.frames(2);
  CHECK(rows() == 7);
  app->interface().make_current();
  std::size_t found = 0;
  for (const ImGuiWindow* w : GImGui->Windows) {
    if (!w->WasActive || std::string_view(w->Name).find("/start") == std::string_view::npos) continue;
    ++found;
    CHECK(w->ContentSize.x <= w->InnerRect.GetWidth());
  }
  CHECK(found == 1);
}

TEST_CASE("left work: that of a program which takes long to end comes at once, also beside older work") {
  const ScratchFolder folder("left_late");
  leave_work(folder, "fox", "autosave.splatcut.json");
  const auto offered_after_end = [&] {
    const int lock = ::open((folder / "autosave.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    REQUIRE(lock >= 0);
    REQUIRE(::flock(lock, LOCK_EX | LOCK_NB) == 0);  // as the other program holds it
    HeadlessApp app(640, 480, 1, with_state(folder));
    app.frames(60 * 3);
    const std::size_t before = app.studio().work().offers().size();
    ::close(lock);
    app.frames(30);
    return app.studio().work().offers().size() - before;
  };
  CHECK(offered_after_end() == 1);
  leave_work(folder, "cup", "autosave.3.splatcut.json");
  CHECK(offered_after_end() == 1);
}

TEST_CASE("left work: that of a program which is killed and still gives its memory back comes at the start") {
  const ScratchFolder folder("left_dying");
  leave_work(folder, "fox", "autosave.splatcut.json");
  const int lock = ::open((folder / "autosave.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  REQUIRE(lock >= 0);
  REQUIRE(::flock(lock, LOCK_EX | LOCK_NB) == 0);
  const auto offered_while_held_by = [&](pid_t program) {
    std::ofstream(folder / "autosave.lock") << program << '\n';
    return HeadlessApp(640, 480, 1, with_state(folder)).studio().work().offers().size();
  };
  CHECK(offered_while_held_by(::getpid()) == 0);
  CHECK(offered_while_held_by(0) == 0);
  const pid_t killed = ::fork();
  if (killed == 0) ::pause();
  ::kill(killed, SIGKILL);
  siginfo_t ended{};
  ::waitid(P_PID, static_cast<id_t>(killed), &ended,
           WEXITED | WNOWAIT);  // as long as nobody asks for its end
  CHECK(offered_while_held_by(killed) == 1);
  HeadlessApp app(640, 480, 1, with_state(folder));
  ::waitpid(killed, nullptr, 0);
  ::close(lock);
  app.frames(60);
  REQUIRE(app.studio().work().offers().size() == 1);
  const int again = ::open((folder / "autosave.lock").c_str(), O_RDWR | O_CLOEXEC);
  CHECK(::flock(again, LOCK_EX | LOCK_NB) != 0);  // this program holds it now
  ::close(again);
  app.studio().apply(DropAutosave{app.studio().work().offers().front().file});
  CHECK_FALSE(std::filesystem::exists(folder / "autosave.splatcut.json"));
}

TEST_CASE("left work: it is offered also while the scene that the program was started with is opened") {
  const ScratchFolder folder("left_beside");
  leave_work(folder, "fox", "autosave.splatcut.json");
  HeadlessApp app(640, 480, 1, with_state(folder));
  app.studio().apply(OpenScene{kSample});  // larger than what is read before the first frame
  app.frames(1);
  REQUIRE_FALSE(app.studio().scene());
  REQUIRE(app.studio().files().opening() == app.studio().coming());
  CHECK(app.button("\nfox").size().x > 0);
}

TEST_CASE("left work: a pointer that lies in the panel, under its rows, hides none of what can be restored") {
  const ScratchFolder folder("left_pointer");
  leave_work(folder, "fox", "autosave.splatcut.json");
  HeadlessApp app(800, 600, 1, with_state(folder));
  app.frames(2);
  app.move({690, 480});
  app.move({690, 500});
  app.open(folder / "fox/point_cloud/iteration_30000/point_cloud.compressed.ply");
  REQUIRE(app.settle());
  app.frames(2);
  REQUIRE(app.button("\nfox").size().x > 0);
  CHECK(app.button("\nfox").max.y <= app.button("Default").min.y);
}

TEST_CASE(
    "left work: a file without work is not offered, one whose work was undone is, as it can be redone") {
  const ScratchFolder folder("left_nothing");
  std::filesystem::copy_file(kSmallSample, folder / "scene.compressed.ply");
  const auto scene = open_scene(folder / "scene.compressed.ply");
  write_work_file(folder / "autosave.splatcut.json", *scene, Document());
  Document deleted;
  deleted.deleted = make_flags(std::vector<std::uint8_t>(scene->cloud->size(), 1));
  write_work_file(folder / "autosave.2.splatcut.json", *scene, deleted);
  write_work_file(folder / "autosave.3.splatcut.json", *scene, Document(), {},
                  {.steps = {{"Scene opened", Document()}, {"Delete", deleted}}, .cursor = 0});
  HeadlessApp app(640, 480, 1, with_state(folder));
  std::vector<std::filesystem::path> offered;
  for (const LeftWork& left : app.studio().work().offers()) offered.push_back(left.file.filename());
  std::ranges::sort(offered);
  CHECK(offered ==
        std::vector<std::filesystem::path>{"autosave.2.splatcut.json", "autosave.3.splatcut.json"});
}

TEST_CASE("left work: beside a scene that of other scenes stands behind one row") {
  const ScratchFolder folder("left_others");
  leave_work(folder, "fox", "autosave.splatcut.json");
  for (int i = 2; i < 5; ++i)
    leave_work(folder, fmt::format("cup{}", i), fmt::format("autosave.{}.splatcut.json", i));
  HeadlessApp app(800, 600, 1, with_state(folder));
  app.open(folder / "fox/point_cloud/iteration_30000/point_cloud.compressed.ply");
  REQUIRE(app.settle());
  app.frames(2);
  const auto shown = [&](const char* capture) { return app.button(capture).size().x > 0; };
  CHECK(shown("\nfox"));
  CHECK_FALSE(shown("\ncup"));
  app.press_item("/scroll", {"###others"});
  for (const char* capture : {"\nfox", "\ncup2", "\ncup3", "\ncup4"}) CHECK(shown(capture));
}

TEST_CASE("left work: how much other scenes have is read in a small window, too") {
  const ScratchFolder folder("left_counted");
  for (int i = 2; i < 5; ++i)
    leave_work(folder, fmt::format("cup{}", i), fmt::format("autosave.{}.splatcut.json", i));
  HeadlessApp app(640, 480, 1, with_state(folder));
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.frames(2);
  const auto& items = app.interface_state().items;
  const auto row = std::ranges::find_if(
      items, [](const ShownItem& i) { return i.name.find("other scenes") != std::string::npos; });
  REQUIRE(row != items.end());
  CAPTURE(row->name);
  CHECK(row->name.find('3') != std::string::npos);
  app->interface().make_current();
  const ImFont* body = app->interface().theme().body;
  const float words = body->CalcTextSizeA(body->FontSize, 1e6f, 0, row->name.c_str()).x;
  const float panel_end = app.window("side/scroll").max.x - ImGui::GetStyle().ScrollbarSize;
  CHECK(row->min.x + ImGui::GetTreeNodeToLabelSpacing() + words <= panel_end + 1);
}
