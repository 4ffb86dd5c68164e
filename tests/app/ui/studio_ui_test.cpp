// The program driven by pointer and keys, without a window.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/cli/work_cut.h"
#include "app/console/camera_options.h"
#include "app/studio/work_file.h"
#include "core/error.h"
#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kWidth = 760, kHeight = 420;

HeadlessApp& opened(HeadlessApp& app) {
  app.open(kSample);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  app.studio().apply(SetPreset{"fast"});
  return app;
}

std::vector<std::uint8_t> active_labels(HeadlessApp& app) {
  return app.studio().labels(app.studio().document().active);
}

}  // namespace

TEST_CASE("a click on the apple cuts out the apple, strokes, undo and redo give the same bytes") {
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  std::vector<std::string> states{bytes_of(app.studio().document())};
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const Scene& scene = *app.studio().scene()->scene;
  const double first = iou_of(active_labels(app), sample_truth(scene, kApple));
  MESSAGE("apple, one click: IoU " << first);
  CHECK(first > 0.9);
  CHECK_FALSE(app.studio().cut_run(app.studio().document().active)->views.empty());
  states.push_back(bytes_of(app.studio().document()));

  app.key('3');
  const glm::vec2 at = app.screen_of(kOnApple);
  app.drag({at, at + glm::vec2(6, 6), at + glm::vec2(12, 4)});
  REQUIRE(app.settle());
  states.push_back(bytes_of(app.studio().document()));
  CHECK(app.studio().document().active_object()->views.front().strokes.size() == 2);
  app.key('=');  // grow, by hand
  states.push_back(bytes_of(app.studio().document()));
  REQUIRE(states.back() != states[2]);

  for (std::size_t i = states.size(); i-- > 1;) {
    app.key('Z', {.ctrl = true});
    REQUIRE(app.settle());
    CHECK(bytes_of(app.studio().document()) == states[i - 1]);
  }
  CHECK(app.studio().history().cursor() == 1);  // the choice of preset
  for (std::size_t i = 1; i < states.size(); ++i) {
    app.key('Z', {.shift = true, .ctrl = true});
    REQUIRE(app.settle());
    CHECK(bytes_of(app.studio().document()) == states[i]);
  }
  CHECK_FALSE(app.studio().history().can_redo());
}

TEST_CASE("two objects: a right click says what is not, the wheel steps through parts, hovering outlines") {
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  app.move(app.screen_of(kOnMug));
  REQUIRE(app.settle());
  const Flags outlined = app.studio().style(0).highlight;
  REQUIRE(outlined);
  const Scene& scene = *app.studio().scene()->scene;
  CHECK(iou_of(*outlined, sample_truth(scene, kMug)) > 0.3);
  app.click(app.screen_of(kOnMug));
  REQUIRE(app.settle());
  const std::size_t before = count_flags(active_labels(app));
  app->handle(WheelTurned{-1, {}});
  REQUIRE(app.settle());
  const std::size_t smaller = count_flags(active_labels(app));
  MESSAGE("mug: IoU " << iou_of(active_labels(app), sample_truth(scene, kMug))
                      << " after a step down; Gaussians " << before << " -> " << smaller);
  CHECK(smaller < before);
  app.key('Z', {.ctrl = true});
  REQUIRE(app.settle());
  CHECK(count_flags(active_labels(app)) == before);

  app.key('N', {.ctrl = true});
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  REQUIRE(app.studio().document().objects.size() == 2);
  CHECK(iou_of(active_labels(app), sample_truth(scene, kOrange)) > 0.9);
  app.click(app.screen_of(kOnApple), PointerButton::kRight);  // it is no part of the orange, and was none
  REQUIRE(app.settle());
  CHECK(app.studio().document().active_object()->views.front().strokes.back().label == SeedLabel::kRest);
  CHECK(iou_of(active_labels(app), sample_truth(scene, kOrange)) > 0.9);
}

TEST_CASE("cancel: in every stage the strokes stay, nothing half done is left, and R computes again") {
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  const glm::vec2 apple = app.screen_of(kOnApple);
  const auto run = [&] { return app.studio().cut_run(app.studio().document().active); };
  const std::pair<const char*, std::function<bool()>> stages[] = {
      {"as it begins", [&] { return app.studio().cutting(); }},
      {"with the first labels", [&] { return run() && run()->preview; }},
      {"between views", [&] { return run() && run()->preview && app.studio().progress().stage == "views"; }},
      {"after the cut", [&] { return app.studio().progress().stage == "pictures of the views"; }}};
  constexpr int kMostFrames = 2000;
  for (const auto& [name, reached] : stages) {
    CAPTURE(name);
    app.click(apple);
    bool was_reached = false;
    for (int i = 0; i < kMostFrames && !was_reached && !app.studio().idle(); ++i) {
      app.frames(1);
      was_reached = reached();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    WARN(was_reached);  // a fast machine may be through before it is seen
    app.key(key::kEscape);
    REQUIRE(app.settle());
    const ObjectItem& object = *app.studio().document().active_object();
    CHECK(object.views.front().strokes.size() == 1);
    CHECK_FALSE((run() && run()->running));
    if (!object.cut) CHECK(count_flags(active_labels(app)) == 0);
    app.studio().apply(Undo{});
    app.studio().apply(SetView{});
    REQUIRE(app.settle());
  }
  app.click(apple);
  app.frames(1);
  app.key(key::kEscape);
  REQUIRE(app.settle());
  app.key('R');
  REQUIRE(app.settle());
  CHECK(iou_of(active_labels(app), sample_truth(*app.studio().scene()->scene, kApple)) > 0.9);
}

TEST_CASE("saved work: read back the same, and computed again bit for bit") {
  const ScratchFolder folder("work");
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  app.key('=');
  app.studio().apply(SetSmoothness{app.studio().document().active, 3.5f});
  REQUIRE(app.settle());
  const auto file = folder / "apple.splatcut.json";
  app.studio().apply(SaveWork{file});
  REQUIRE(app.settle());
  REQUIRE(std::filesystem::exists(file));
  CHECK_FALSE(app.studio().unsaved());
  const auto labels = active_labels(app);
  const std::string bytes = bytes_of(app.studio().document());

  const auto scene = open_scene(read_work_file(file).scene);
  const Document read = restored(read_work_file(file), *scene->scene, scene->hash).document;
  CHECK(bytes_of(read) == bytes);
  Document empty = read;
  for (ObjectItem& object : empty.objects) object.cut = nullptr;
  const Document again = computed_again(*scene, empty);
  CHECK(labels_of(again, *again.active_object(), labels.size()) == labels);
  CHECK(bytes_of(again) == bytes);

  app.open(file);  // and the window opens it
  REQUIRE(app.settle());
  CHECK(bytes_of(app.studio().document()) == bytes);
}

TEST_CASE("saved work: what is wrong with a file is said in one sentence") {
  const ScratchFolder folder("wrong_work");
  const auto file = folder / "wrong.splatcut.json";
  const auto scene = open_scene(kSample);
  Document document;
  add_object(&document, "mug");
  write_work_file(file, *scene->scene, scene->hash, document);
  const nlohmann::json right = nlohmann::json::parse(std::ifstream(file));
  const auto said_of = [&](const nlohmann::json& work) -> std::string {
    std::ofstream(file) << work;
    try {
      restored(read_work_file(file), *scene->scene, scene->hash);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  CHECK(said_of(right).empty());
  nlohmann::json no_up = right;
  no_up["up"] = {0, 0, 0};
  CHECK(said_of(no_up) == file.string() + ": up: is no direction.");
  nlohmann::json no_view = right;
  no_view["view"] = {
      {"camera_from_world", {0, 0, 0, 0}}, {"position", {0, 0, 0}}, {"distance", 1}, {"fov_y_rad", 1}};
  CHECK(said_of(no_view) == file.string() + ": view: is no place to look from.");
  const auto said_of_version = [&](const nlohmann::json& version) {
    nlohmann::json work = right;
    work["splatcut_work"] = version;
    return said_of(work);
  };
  CHECK(said_of_version(1000).find("newer splatcut") != std::string::npos);
  for (const nlohmann::json& version :
       {nlohmann::json(0), nlohmann::json(-2), nlohmann::json("3"), nlohmann::json(2.5)})
    CHECK(said_of_version(version) ==
          file.string() + ": its version " + version.dump() + " is none that a splatcut writes.");
}

TEST_CASE("after a click, views around the object are there to look from, and have no say") {
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const auto& views = app.studio().cut_run(app.studio().document().active)->views;
  REQUIRE(views.size() > 3);
  CHECK_FALSE(views.front().only_to_look);
  CHECK(views.front().used);
  for (std::size_t i = 1; i < views.size(); ++i) {
    CHECK(views[i].only_to_look);
    CHECK_FALSE(views[i].used);
    CHECK(views[i].picture);
  }
}

TEST_CASE("a view left out is that view: after a save, and after another preset was tried") {
  const ScratchFolder folder("left_out");
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  app.studio().apply(SetPreset{"best"});
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const ObjectId id = app.studio().document().active;
  const auto views = [&] { return app.studio().cut_run(id)->views; };
  REQUIRE(views().size() > 2);
  const Camera camera = views()[2].camera;
  app.studio().apply(LeaveOutView{id, camera, true});
  REQUIRE(app.settle());
  const auto counts = [&](const Camera& c) {
    for (const ViewCard& card : views())
      if (same_view(card.camera, c)) return card.used ? "used" : "left out";
    return "not looked at";
  };
  CHECK(counts(camera) == std::string("left out"));
  const auto labels = active_labels(app);
  app.studio().apply(SetPreset{"fast"});
  REQUIRE(app.settle());
  CHECK(std::ranges::count_if(views(), &ViewCard::used) == 1);
  app.studio().apply(SetPreset{"best"});
  REQUIRE(app.settle());
  CHECK(counts(camera) == std::string("left out"));
  CHECK(active_labels(app) == labels);
  const auto file = folder / "apple.splatcut.json";
  app.studio().apply(SaveWork{file});
  REQUIRE(app.settle());
  const auto scene = open_scene(read_work_file(file).scene);
  const RestoredWork read = restored(read_work_file(file), *scene->scene, scene->hash);
  CHECK(read.warning.empty());
  CHECK(bytes_of(read.document) == bytes_of(app.studio().document()));

  // An older file knew a number: what it was the number of, nobody knows.
  std::ifstream in(file);
  nlohmann::json old = nlohmann::json::parse(in);
  old["splatcut_work"] = 1;
  old["objects"][0]["left_out"] = {2};
  std::ofstream(file) << old;
  const RestoredWork numbered = restored(read_work_file(file), *scene->scene, scene->hash);
  CHECK(numbered.warning.find("Leave them out again") != std::string::npos);
  CHECK(numbered.document.objects[0].left_out.empty());
  CHECK(is_stale(numbered.document, numbered.document.objects[0]));
}

TEST_CASE("work is saved by itself and offered after a crash") {
  const ScratchFolder folder("state");
  std::string bytes;
  CameraPose pose;
  {
    ApplicationOptions options;
    options.studio.state_folder = folder.path();
    HeadlessApp app(kWidth, kHeight, 1, options);
    CHECK_FALSE(app.studio().autosave_found());
    opened(app);
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
    app.frames(60 * 3);
    REQUIRE(app.settle());
    bytes = bytes_of(app.studio().document());
    app.studio().camera().orbit({60, 20});  // the view alone
    pose = app.studio().camera().pose();
    app.frames(60 * 11);
    REQUIRE(app.settle());
  }  // no leave(): as if it had crashed
  REQUIRE(std::filesystem::exists(folder / "autosave.splatcut.json"));
  ApplicationOptions options;
  options.studio.state_folder = folder.path();
  HeadlessApp app(kWidth, kHeight, 1, options);
  CHECK(app.studio().autosave_found());
  CHECK(app.studio().autosave_says().starts_with("sample.compressed.ply, 20"));
  // Started with a scene and worked on: what is offered is still there.
  opened(app);
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  app.frames(60 * 3);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / kAutosave));
  REQUIRE(app.studio().autosave_found());
  app.studio().apply(RestoreAutosave{});
  REQUIRE(app.settle());
  CHECK(bytes_of(app.studio().document()) == bytes);
  CHECK(app.studio().camera().pose() == pose);
  CHECK(std::ranges::any_of(app.studio().messages(), [&](const Message& m) {
    return m.text == "Restoring the work of last time: " + app.studio().autosave_says();
  }));
  CHECK_FALSE(app.studio().autosave_found());
  CHECK(app.studio().unsaved());  // it is nowhere else yet
  app.frames(60 * 3);
  REQUIRE(app.settle());
  app.studio().leave();
  REQUIRE(std::filesystem::exists(folder / kAutosave));
  CHECK_FALSE(std::filesystem::exists(folder / kAutosaveBefore));
  const auto again = open_scene(read_work_file(folder / kAutosave).scene);
  CHECK(bytes_of(restored(read_work_file(folder / kAutosave), *again->scene, again->hash).document) == bytes);
}

TEST_CASE("work that was saved by itself stays offered where its scene cannot be opened") {
  const ScratchFolder folder("state_without_scene");
  const auto moved = folder / "moved.compressed.ply";
  std::filesystem::copy_file(kSample, moved);
  const auto scene = open_scene(moved);
  Document document;
  add_object(&document, "mug");
  write_work_file(folder / kAutosave, *scene->scene, scene->hash, document);
  std::filesystem::rename(moved, folder / "elsewhere");
  ApplicationOptions options;
  options.studio.state_folder = folder.path();
  HeadlessApp app(kWidth, kHeight, 1, options);
  app.studio().apply(RestoreAutosave{});
  REQUIRE(app.settle());
  CHECK(app.studio().messages().back().text.find("moved.compressed.ply") != std::string::npos);
  CHECK(app.studio().autosave_found());
  std::filesystem::rename(folder / "elsewhere", moved);
  app.studio().apply(RestoreAutosave{});
  REQUIRE(app.settle());
  CHECK(app.studio().document().objects.size() == 1);
  CHECK_FALSE(app.studio().autosave_found());
}

TEST_CASE("opening asks before unsaved work goes, dropped files and recent ones alike") {
  const ScratchFolder folder("open_asks");
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  const std::string bytes = bytes_of(app.studio().document());
  const std::uint64_t scene = app.studio().scene()->serial;
  REQUIRE(app.studio().unsaved());
  app.open(kSample);
  app.frames(3);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  CHECK(bytes_of(app.studio().document()) == bytes);
  CHECK(app.studio().scene()->serial == scene);
  app.open(kSample);
  app.frames(3);
  app.click({kWidth / 2 - 45, kHeight / 2 + 75 - 28});  // Open
  REQUIRE(app.settle());
  CHECK(app.studio().scene()->serial != scene);
  CHECK(app.studio().document().objects.empty());
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  app.studio().apply(SaveWork{folder / "all.splatcut.json"});
  REQUIRE(app.settle());
  const std::uint64_t saved = app.studio().scene()->serial;
  app.open(kSample);  // nothing would be lost
  REQUIRE(app.settle());
  CHECK(app.studio().scene()->serial != saved);
}

TEST_CASE("objects: one byte per Gaussian names 255 of them, the 256th is refused with a sentence") {
  const ScratchFolder folder("objects");
  Document document;
  for (std::size_t i = 0; i < kMostObjects; ++i) add_object(&document);
  CHECK_THROWS_WITH_AS(add_object(&document),
                       "objects: there are 255 already, more cannot be shown. Merge or remove some.", Error);
  CHECK(document.objects.size() == kMostObjects);
  CHECK(document.next_id == kMostObjects + 1);

  const auto scene = open_scene(kSample);
  const auto file = folder / "many.splatcut.json";
  write_work_file(file, *scene->scene, scene->hash, document);
  CHECK(restored(read_work_file(file), *scene->scene, scene->hash).document.objects.size() == kMostObjects);
  ObjectItem another = document.objects.back();
  another.id = document.next_id++;
  document.objects.push_back(another);
  write_work_file(file, *scene->scene, scene->hash, document);
  CHECK_THROWS_AS(restored(read_work_file(file), *scene->scene, scene->hash), Error);
}

TEST_CASE("far limit: what lies beyond is neither drawn nor picked nor selected") {
  HeadlessApp app(kWidth, kHeight);
  opened(app);
  const glm::vec2 wall(60, 60), apple = app.screen_of(kOnApple) - app->interface().viewport().min;
  REQUIRE(app.studio().pick(wall));
  REQUIRE(app.studio().pick(apple));
  const Camera camera = app.studio().viewport_camera();
  const auto depth = [&](const glm::vec2& at) {
    return camera.camera_from_world(app.studio().pick(at)->position_world).z;
  };
  const float near_z = depth(apple), far_z = depth(wall), limit = 0.5f * (near_z + far_z);
  REQUIRE(near_z < far_z);
  ViewState view = app.studio().view();
  view.far_share = limit / app.studio().camera().scene_size();
  app.studio().apply(SetView{view});
  CHECK_FALSE(app.studio().pick(wall));  // one pixel drawn for the question
  REQUIRE(app.settle());
  CHECK_FALSE(app.studio().pick(wall));  // the picture on the screen
  CHECK(app.studio().pick(apple));
  const Frame& frame = *app.studio().picture()->frames.front();
  const GaussianCloud& cloud = *app.studio().scene()->cloud;
  float farthest = 0;
  for (const std::int32_t g : frame.first_hit.pixels())
    if (g >= 0)
      farthest = std::max(farthest, camera.camera_from_world(cloud.position[static_cast<std::size_t>(g)]).z);
  CHECK(farthest <= limit);
  CHECK(farthest > near_z);
  view.far_share = 0;
  app.studio().apply(SetView{view});
  REQUIRE(app.settle());
  CHECK(app.studio().pick(wall));
}

TEST_CASE(
    "a scene without cameras: the commands stand where the window opens it, whatever is up in the file") {
  const ScratchFolder folder("no_cameras");
  Scene scene = load_scene(kSample);
  const glm::quat stood_up = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0));  // -y to +z
  for (glm::vec3& p : scene.cloud.position) p = stood_up * p;
  for (glm::quat& q : scene.cloud.rotation) q = stood_up * q;
  const auto file = folder / "turned.splat";
  save_scene(file, scene, {}, SceneFormat::kSplat);
  HeadlessApp app(kWidth, kHeight);
  app.open(file);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  CHECK(app.studio().scene()->cameras.empty());
  const Camera window = app.studio().viewport_camera();
  CameraOptions options;
  options.size = fmt::format("{}x{}", window.width_px, window.height_px);
  const ChosenCamera chosen = choose_camera(options, *app.studio().scene()->cloud);
  CHECK(glm::distance(chosen.up_world, glm::vec3(0, 0, 1)) < 1e-6f);
  CHECK(glm::distance(chosen.camera.centre_world(), window.centre_world()) < 1e-3f);
  CHECK(glm::distance(chosen.camera.forward_world(), window.forward_world()) < 1e-4f);
  CHECK(glm::distance(chosen.camera.down_world(), window.down_world()) < 1e-4f);
  CHECK(chosen.camera.fy_px == doctest::Approx(window.fy_px).epsilon(1e-4));

  options.position = "0,0,5", options.target = "0,0,0";  // straight down: the guess must not refuse it
  CHECK_NOTHROW(choose_camera(options, scene.cloud));
  options.up = "0,0,1";
  CHECK_THROWS_AS(choose_camera(options, scene.cloud), Error);
}
