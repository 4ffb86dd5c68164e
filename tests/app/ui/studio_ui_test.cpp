// The program driven by pointer and keys, without a window.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <functional>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "app/console/camera_options.h"
#include "app/ui/panels.h"
#include "app/ui/theme.h"
#include "app/window/file_drag.h"
#include "app/work/work_file.h"
#include "core/error.h"
#include "hands.h"
#include "opened_sample.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("a click on the apple cuts out the apple, strokes, undo and redo give the same bytes") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  std::vector<Document> states{app.studio().document()};
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const Scene& scene = *app.studio().scene()->scene;
  const double first = iou_of(active_labels(app), sample_truth(scene, kApple));
  MESSAGE("apple, one click: IoU " << first);
  CHECK(first > 0.9);
  CHECK_FALSE(app.studio().cuts().run(app.studio().document().active)->views.empty());
  states.push_back(app.studio().document());

  app.key('3');
  const glm::vec2 at = app.screen_of(kOnApple);
  app.drag({at, at + glm::vec2(6, 6), at + glm::vec2(12, 4)});
  REQUIRE(app.settle());
  states.push_back(app.studio().document());
  CHECK(app.studio().document().active_object()->views.front().strokes.size() == 2);
  app.key('=', {.ctrl = true});  // grow, by hand
  REQUIRE(app.settle());
  states.push_back(app.studio().document());
  REQUIRE_FALSE(same(states.back(), states[2]));

  for (std::size_t i = states.size(); i-- > 1;) {
    app.key('Z', {.ctrl = true});
    REQUIRE(app.settle());
    CHECK(same(app.studio().document(), states[i - 1]));
  }
  CHECK(app.studio().history().cursor() == 0);
  for (std::size_t i = 1; i < states.size(); ++i) {
    app.key('Z', {.shift = true, .ctrl = true});
    REQUIRE(app.settle());
    CHECK(same(app.studio().document(), states[i]));
  }
  CHECK_FALSE(app.studio().history().can_redo());
}

TEST_CASE("two objects: a right click says what is not, the wheel steps through parts, hovering outlines") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  app.move(app.screen_of(kOnMug));
  REQUIRE(app.settle());
  const Flags outlined = app.studio().viewport().style(0).highlight;
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
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  const glm::vec2 apple = app.screen_of(kOnApple);
  const auto run = [&] { return app.studio().cuts().run(app.studio().document().active); };
  const std::pair<const char*, std::function<bool()>> stages[] = {
      {"as it begins", [&] { return app.studio().cutting(); }},
      {"with the first labels", [&] { return run() && run()->preview; }},
      {"after the cut", [&] { return app.studio().progress().stage == "pictures of the views"; }}};
  constexpr int kMostFrames = 2000;
  int stages_reached = 0;
  for (const auto& [name, reached] : stages) {
    CAPTURE(name);
    app.click(apple);
    bool was_reached = reached();
    for (int i = 0; i < kMostFrames && !was_reached && !app.studio().idle(); ++i) {
      app.frames(1);
      was_reached = reached();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    stages_reached += was_reached;
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
  CHECK(stages_reached >= 2);  // one may be over before a frame sees it
  app.click(apple);
  app.frames(1);
  app.key(key::kEscape);
  REQUIRE(app.settle());
  app.key('R');
  REQUIRE(app.settle());
  CHECK(iou_of(active_labels(app), sample_truth(*app.studio().scene()->scene, kApple)) > 0.9);
}

TEST_CASE("after a click, views around the object are there to look from, and have no say") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const auto& views = app.studio().cuts().run(app.studio().document().active)->views;
  REQUIRE(views.size() > 3);
  CHECK_FALSE(views.front().only_to_look);
  CHECK(views.front().used);
  for (std::size_t i = 1; i < views.size(); ++i) {
    CHECK(views[i].only_to_look);
    CHECK_FALSE(views[i].used);
    CHECK(views[i].picture);
  }
}

TEST_CASE("far limit: what lies beyond is neither drawn nor picked nor selected") {
  HeadlessApp app(kSmallWidth, kSmallHeight);
  opened(app);
  const glm::vec2 wall(60, 60), apple = app.screen_of(kOnApple) - app->interface().viewport().min;
  REQUIRE(app.studio().viewport().pick(wall));
  REQUIRE(app.studio().viewport().pick(apple));
  const Camera camera = app.studio().viewport().pane_camera();
  const auto depth = [&](const glm::vec2& at) {
    return camera.camera_from_world(app.studio().viewport().pick(at)->position_world).z;
  };
  const float near_z = depth(apple), far_z = depth(wall), limit = 0.5f * (near_z + far_z);
  REQUIRE(near_z < far_z);
  ViewState view = app.studio().view();
  view.far_share = limit / app.studio().camera().scene_size();
  app.studio().apply(SetView{view});
  CHECK_FALSE(app.studio().viewport().pick(wall));  // one pixel drawn for the question
  REQUIRE(app.settle());
  CHECK_FALSE(app.studio().viewport().pick(wall));  // the picture on the screen
  CHECK(app.studio().viewport().pick(apple));
  const Frame& frame = *app.studio().viewport().picture()->frames.front();
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
  CHECK(app.studio().viewport().pick(wall));
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
  HeadlessApp app(kSmallWidth, kSmallHeight);
  app.open(file);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  CHECK(app.studio().scene()->views().cameras.empty());
  const Camera window = app.studio().viewport().pane_camera();
  CameraOptions options;
  options.size = fmt::format("{}x{}", window.width_px, window.height_px);
  const ChosenCamera chosen = choose_camera(options, *app.studio().scene()->scene);
  CHECK(glm::distance(chosen.up_world, glm::vec3(0, 0, 1)) < 1e-6f);
  CHECK(glm::distance(chosen.camera.centre_world(), window.centre_world()) < 1e-3f);
  CHECK(glm::distance(chosen.camera.forward_world(), window.forward_world()) < 1e-4f);
  CHECK(glm::distance(chosen.camera.down_world(), window.down_world()) < 1e-4f);
  CHECK(chosen.camera.fy_px == doctest::Approx(window.fy_px).epsilon(1e-4));

  options.position = "0,0,5", options.target = "0,0,0";  // straight down: the guess must not refuse it
  CHECK_NOTHROW(choose_camera(options, scene));
  options.up = "0,0,1";
  CHECK_THROWS_AS(choose_camera(options, scene), Error);
}

TEST_CASE("ui: what was exported last is dragged out of the window, or its path is copied by a click") {
  const ScratchFolder folder("drag_out");
  Hands hands(false);
  UiState& state = hands.app.interface_state();
  hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "all.splat"}});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  CHECK(hands.studio().exports().last() == folder / "all.splat");
  const UiRect button = hands.app.button("all.splat");
  REQUIRE(button.size().x > 0);
  const glm::vec2 row = 0.5f * (button.min + button.max);
  hands.app.move(row);
  hands.app.press(PointerButton::kLeft);
  hands.app.frames(2);
  CHECK_FALSE(state.dragged_out);
  hands.app.move(row + glm::vec2(12, 0));
  hands.app.frames(1);
  CHECK(state.dragged_out == folder / "all.splat");
  state.dragged_out.reset();  // the window takes it
  hands.app.move(row + glm::vec2(60, 5));
  hands.app.frames(2);
  CHECK_FALSE(state.dragged_out);  // once
  hands.app.move(row + glm::vec2(300, 300));
  hands.app.release(PointerButton::kLeft);
  hands.app.frames(2);
  hands.app.click(row);
  hands.app.frames(1);
  CHECK(std::string(ImGui::GetClipboardText()) == folder / "all.splat");
}

TEST_CASE("ui: what was exported of a scene is not shown with another one") {
  const ScratchFolder folder("exported_before");
  Hands hands(false);
  hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "all.splat"}});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  REQUIRE(hands.app.button("all.splat").size().x > 0);
  hands.studio().apply(OpenScene{kSample});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  REQUIRE(hands.studio().scene()->scene->path == kSample);
  CHECK(hands.app.button("all.splat").size().x == 0);
  CHECK(hands.studio().exports().last().empty());
}

TEST_CASE("ui: the address of a file that is dragged out is one that other programs read") {
  CHECK(file_uri("/a b/ä%.ply") == "file:///a%20b/%C3%A4%25.ply");
  CHECK(file_uri("/plain-1_2.~/x.ply") == "file:///plain-1_2.~/x.ply");
}

TEST_CASE("ui: the buttons of the bar lie beside each other in a window of any width") {
  for (const int width : {640, 720, 799, 800, 879, 880, 1000, 1280}) {
    CAPTURE(width);
    HeadlessApp app(width, 480);
    app.open(kSmallSample);
    REQUIRE(app.settle());
    std::vector<ShownItem> bar;
    for (const ShownItem& item : app.interface_state().items)
      if (item.max.y < app->interface().viewport().min.y) bar.push_back(item);
    std::ranges::sort(bar, {}, [](const ShownItem& item) { return item.min.x; });
    CHECK(bar.size() > 12);
    CHECK(bar.back().max.x <= static_cast<float>(width));
    for (std::size_t i = 1; i < bar.size(); ++i)
      CHECK_MESSAGE(bar[i - 1].max.x <= bar[i].min.x, bar[i - 1].name << " runs into " << bar[i].name);
  }
}

TEST_CASE("ui: what a small window has no room for in the bar opens behind its last arrow") {
  HeadlessApp app(640, 480);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const auto named = [&](const std::string& name) {
    std::vector<ShownItem> items = app.interface_state().items;
    std::erase_if(items, [&](const ShownItem& item) { return item.name != name; });
    std::ranges::sort(items, {}, [](const ShownItem& item) { return item.min.x; });
    return items;
  };
  REQUIRE(named(icon::kDown).size() >= 2);
  REQUIRE(named("Clean").empty());
  const ShownItem last = named(icon::kDown).back();
  app.click(0.5f * (last.min + last.max));
  app.frames(3);
  CHECK(named("Clean").size() == 1);
  CHECK(named(icon::kColumns).size() == 1);
  CHECK(named(icon::kTint).size() == 1);
}

TEST_CASE("ui: in a window of 640 by 480 the panel takes a third and cuts no button off") {
  constexpr float kWidth = 640, kHeight = 480;
  HeadlessApp app(static_cast<int>(kWidth), static_cast<int>(kHeight));
  app.interface_state().hint_wanted = false;
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const float side = app->interface().viewport().max.x;
  CHECK(kWidth - side <= kWidth / 3 + 1);
  for (const char* title : {"Repair by hand", "View", "Files"}) app.press_item("side/scroll", {title});
  app.frames(2);
  std::size_t seen = 0;
  for (const ShownItem& item : app.interface_state().items) {
    if (item.name == "picture") continue;
    CAPTURE(item.name);
    CHECK(item.max.x <= kWidth);
    seen += item.min.x >= side;
  }
  CHECK(seen > 20);  // of all sections
  app.press_item("side/scroll", {"Files"});
  app.key(key::kF1);
  app.frames(2);
  const UiRect page = app.window("Keys and pointer");
  CHECK(page.max.x <= kWidth);
  CHECK(page.max.y <= kHeight);
}

TEST_CASE("ui: buttons of the right panel stay in their places while the pointer is at them") {
  HeadlessApp app(1000, 1200);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.press_item("side/scroll", {"Repair by hand"});
  app.click(app.screen_of(kOnApple));
  app.frames(1);
  REQUIRE(app.studio().cutting());
  REQUIRE(app.button("Cancel").size().x > 0);
  const UiRect grow = app.button("Grow");
  app.move(0.5f * (grow.min + grow.max));
  std::size_t frames = 0;
  for (; !app.studio().idle() && frames < 100'000; ++frames) {
    app.frames(1);
    REQUIRE(app.button("Grow").min == grow.min);
  }
  REQUIRE(app.settle());
  CHECK(app.button("Cancel").size().x == 0);
  CHECK(app.button("Grow").min == grow.min);
  app.click(0.5f * (grow.min + grow.max));
  REQUIRE(app.settle());
  CHECK(app.studio().history().entries().back().title.find("row") != std::string::npos);
  app.move(0.5f * (app->interface().viewport().min + app->interface().viewport().max));
  app.frames(2);
  CHECK(app.button("Grow").min.y != grow.min.y);  // the progress has gone
}

TEST_CASE("ui: the right panel makes room for what keys bring, wherever the pointer was left") {
  HeadlessApp app(800, 600);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.press_item("side/scroll", {"Repair by hand"});
  const UiRect grow = app.button("Grow");
  for (const float right : {0.0f, 1.0f}) {  // it is moved there
    app.move(0.5f * (grow.min + grow.max) + glm::vec2(right, 0));
    app.frames(1);
  }
  app.key(key::kRight);
  app.key(key::kEnter);
  REQUIRE(app.settle());
  app.frames(2);
  REQUIRE(app.studio().document().active_object());
  CHECK(app.button(icon::kRefresh).max.y <= app.button("Grow").min.y);
}

TEST_CASE("ui: the history follows the steps as they are added, while nobody looks elsewhere in it") {
  HeadlessApp app(800, 600);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.move(0.5f * (app->interface().viewport().min + app->interface().viewport().max));
  app.key('U', {.ctrl = true});
  const auto panel = [&]() -> ImGuiWindow& {
    app->interface().make_current();
    const auto found = std::ranges::find_if(GImGui->Windows, [](const ImGuiWindow* w) {
      return w->WasActive && std::string_view(w->Name).find("side/scroll") != std::string_view::npos;
    });
    REQUIRE(found != GImGui->Windows.end());
    return **found;
  };
  const auto add_steps = [&] {
    for (int i = 0; i < 30; ++i) {
      app.studio().apply(SetUp{i % 2 == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)});
      app.frames(2);
    }
    REQUIRE(app.settle());
    app.frames(2);
  };
  add_steps();
  REQUIRE(panel().ScrollMax.y > 100);
  CHECK(panel().Scroll.y == panel().ScrollMax.y);  // the newest is the last
  ImGui::SetScrollY(&panel(), 0);
  app.frames(2);
  add_steps();
  CHECK(panel().Scroll.y == 0);  // one looks at the objects
}

TEST_CASE("ui: in a small window the hint can be closed, and thumbnails cover little of the picture") {
  HeadlessApp app(640, 480);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.frames(2);
  const UiRect view = app->interface().viewport(), cross = app.button(icon::kClose);
  REQUIRE(cross.size().x > 0);
  CHECK(cross.max.x <= view.max.x);
  app.click(0.5f * (cross.min + cross.max));
  app.frames(2);
  CHECK(app.button(icon::kClose).size().x == 0);
  CHECK(app.studio().document().objects.empty());
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const float covered = app->interface().covered_bottom(app.studio());
  CHECK(covered > 0);
  CHECK(covered < 0.18f * view.size().y);
}

TEST_CASE("ui: the page of keys shows all of them at once in a window of 1600 by 1000") {
  HeadlessApp app(1600, 1000);
  app.frames(1);
  app.key(key::kF1);
  app.frames(3);
  app->interface().make_current();
  std::size_t found = 0;
  for (const ImGuiWindow* w : GImGui->Windows) {
    if (!w->WasActive || std::string_view(w->Name).find("/keys") == std::string_view::npos) continue;
    ++found;
    CHECK(w->ScrollMax.y == 0);
  }
  CHECK(found == 1);
}

TEST_CASE(
    "ui: the start page lies within the picture's place in a window of any size, with all its buttons") {
  const ScratchFolder folder("start_page");
  Document document;
  add_object(&document, "mug");
  write_work_file(folder / "autosave.splatcut.json", *open_scene(kSmallSample), document);
  ApplicationOptions options = with_kept_scenes();
  options.studio.state_folder = folder.path();
  options.sample = kSample;
  for (const auto& [width, height, scale] : {std::tuple(640, 480, 1.0f), std::tuple(800, 480, 1.0f),
                                             std::tuple(1280, 960, 2.0f), std::tuple(1280, 720, 1.0f)}) {
    CAPTURE(width);
    HeadlessApp app(width, height, scale, options);
    app.frames(4);
    const UiRect area = app->interface().viewport(), page = app.window("start");
    CHECK(page.min.x >= area.min.x);
    CHECK(page.max.x <= area.max.x);
    CHECK(page.min.y >= area.min.y);
    CHECK(page.max.y <= area.max.y);
    for (const char* name : {"Open a file", "Open the sample scene", "small_sample", icon::kTrash}) {
      CAPTURE(name);
      const UiRect button = app.button(name);
      CHECK(button.size().x > 0);
      CHECK(button.min.x >= page.min.x);
      CHECK(button.max.x <= page.max.x);
      CHECK(button.max.y <= page.max.y);
    }
  }
}

TEST_CASE("ui: no key of the F1 page runs into what it does, in any group") {
  HeadlessApp app(1280, 720);
  app.frames(1);
  app.key(key::kF1);
  app.frames(3);
  app->interface().make_current();
  for (const Binding& b : key_bindings())
    CHECK_MESSAGE(ImGui::CalcTextSize(keys_of(b.action).c_str()).x + 8 <= keys_width(), b.what);
}

TEST_CASE("ui: a window of 640 by 480 shows every tool and every option of each, a smaller one scrolls") {
  const auto window = [](const char* name) {
    const ImGuiWindow* found = ImGui::FindWindowByName(name);
    return found && found->WasActive ? found : nullptr;
  };
  HeadlessApp app(640, 480);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app->interface().make_current();
  REQUIRE(window("tools"));
  CHECK(window("tools")->ScrollMax.y == 0);
  std::size_t rows = 0;
  for (const Tool* tool : tools())
    for (const bool through : {false, true}) {
      ViewState view = app.studio().view();
      view.tool = *tool;
      view.see_through = through;
      app.studio().apply(SetView{view});
      app.frames(4);
      app->interface().make_current();
      CAPTURE(tool->name);
      if (!window("options")) continue;
      ++rows;
      CHECK(window("options")->ScrollMax.x == 0);
      CHECK(window("options")->ScrollMax.y == 0);
    }
  CHECK(rows > 10);
  HeadlessApp small(640, 480, 1.5f);
  small.open(kSmallSample);
  REQUIRE(small.settle());
  small->interface().make_current();
  REQUIRE(window("tools")->ScrollMax.y > 0);
  small.move({20, 200});
  small.frames(1);
  small->handle(WheelTurned{-5, {}});
  small.frames(2);
  CHECK(window("tools")->Scroll.y > 0);
}
