// The right panel: it stays under the pointer, makes room for keys, follows the history.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "app/ui/theme.h"
#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

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
  CHECK(app.button("Grow").min == grow.min);  // the progress was not above it
}

TEST_CASE("ui: thumbnails lie under the rows of the right panel, and stay while one aims at the panel") {
  HeadlessApp app(1000, 700);
  REQUIRE(cut_out_apple(app, kSmallSample));
  app.frames(2);
  const UiRect view = app->interface().viewport(), rows = app.window("side/scroll"),
               cards = app.window("side/cards"), first = app.button("side 0"), second = app.button("side 1");
  CHECK(cards.min.x > view.max.x);
  CHECK(cards.min.y > rows.max.y);
  CHECK(first.min.y == second.min.y);
  CHECK(first.max.x < second.min.x);
  const UiRect begin = app.button("New object");
  app.click(0.5f * (begin.min + begin.max));
  REQUIRE(app.settle());
  app.frames(2);
  REQUIRE(app.studio().cuts().run(app.studio().document().active) == nullptr);
  CHECK(app.window("side/scroll").max.y < cards.min.y);
  app.move(view.min + glm::vec2(40, 200));
  app.frames(2);
  CHECK(app.window("side/scroll").max.y > cards.max.y - 20);
}

TEST_CASE("ui: a message lies in the lower corner that covers less of the object") {
  HeadlessApp app(1000, 700);
  app.interface_state().hint_wanted = false;
  app.open(kSample);
  REQUIRE(app.settle());
  for (const bool at_left : {true, false}) {
    CAPTURE(at_left);
    app.studio().apply(NewObject{});
    const Camera camera = app.studio().viewport().pane_camera();
    Mask corner(camera.width_px, camera.height_px);
    for (int y = camera.height_px - 60; y < camera.height_px; ++y)
      for (int x = 0; x < 160; ++x) corner.at(at_left ? x : camera.width_px - 1 - x, y) = kMaskObject;
    app.studio().apply(SelectRegion{camera, corner});
    REQUIRE(app.settle());
    app.frames(2);
    REQUIRE(app.studio().gaussians_of(app.studio().document().active) > 0);
    REQUIRE_FALSE(app.studio().messages().empty());
    CAPTURE(app.studio().messages().back().text);
    const UiRect view = app->interface().viewport(), said = app.interface_state().message;
    CHECK((said.min.x > view.min.x + 100) == at_left);
    CHECK(said.min.y > 0.5f * (view.min.y + view.max.y));
  }
}

TEST_CASE(
    "ui: no message lies over the badge of another meaning or the dot of a click, in a small window either") {
  for (const glm::ivec2& size : {glm::ivec2(640, 480), {1000, 700}}) {
    CAPTURE(size.x);
    HeadlessApp app(size.x, size.y);
    app.interface_state().hint_wanted = false;
    REQUIRE(cut_out_apple(app));
    const Camera camera = app.studio().viewport().pane_camera();
    const glm::vec2 low(0.2f * static_cast<float>(camera.width_px),
                        static_cast<float>(camera.height_px) - 30),
        high(0.8f * static_cast<float>(camera.width_px), low.y);
    for (const glm::vec2& at : {low, high}) {  // dots in both lower corners
      app.studio().apply(AddStroke{camera, click(at, SeedLabel::kRest)});
      REQUIRE(app.settle());
    }
    app.wait_for_message_to_go();
    app.studio().apply(AddBox{camera, {5, 5}, {7, 7}});  // is refused
    app.frames(3);
    const UiRect view = app->interface().viewport(), said = app.interface_state().message;
    REQUIRE(said.size().x > 0);
    std::vector<glm::vec2> marks = app.interface_state().badges;
    for (const StrokeMark& mark : app.studio().viewport().marks()) marks.push_back(view.min + mark.at_px);
    REQUIRE(app.studio().viewport().marks().size() >= 2);
    for (const glm::vec2& at : marks) CHECK_FALSE(said.contains(at));
  }
}

TEST_CASE("ui: what is said of a thumbnail does not cover a message, in a narrow window either") {
  HeadlessApp app(640, 480);
  app.interface_state().hint_wanted = false;
  REQUIRE(cut_out_apple(app));
  app.frames(2);
  std::size_t low = 0;
  for (int side = 0; side < 6; ++side) {
    const UiRect card = app.button("side " + std::to_string(side));
    REQUIRE(card.size().x > 0);
    app.studio().apply(AddBox{app.studio().viewport().pane_camera(), {5, 5}, {7, 7}});  // is refused
    app.move(0.5f * (card.min + card.max));
    app.frames(60);
    const UiRect tip = app.window("##Tooltip_00"), said = app.interface_state().message;
    REQUIRE(said.size().x > 0);
    REQUIRE(tip.size().x > 0);
    CAPTURE(side);
    CHECK((tip.max.y <= said.min.y || tip.max.x <= said.min.x || tip.min.x >= said.max.x));
    CHECK(tip.min.y >= 0);
    low += card.max.y > said.min.y;
  }
  CHECK(low > 0);
}

TEST_CASE("ui: a thumbnail under the pointer is shown larger beside the panel, and sharp once it is drawn") {
  HeadlessApp app(1360, 860);
  app.interface_state().hint_wanted = false;
  REQUIRE(cut_out_apple(app));
  app.wait_for_message_to_go();
  const auto view = [&]() -> const ViewCard& {
    return app.studio().cuts().run(app.studio().document().active)->views.at(1);
  };
  CHECK_FALSE(view().large);  // nobody looks
  const UiRect card = app.button("side 1");
  app.move(0.5f * (card.min + card.max));
  app.frames(2);
  const UiRect tip = app.window("##Tooltip_00");
  CHECK(tip.size().x >= 2.5f * card.size().x);
  CHECK(tip.size().y >= 2.5f * card.size().y);
  CHECK(tip.max.x <= app->interface().viewport().max.x);
  REQUIRE(app.frames_until([&] { return view().large != nullptr; }));
  const Image<Rgba8>&large = *view().large, &small = *view().picture;
  CHECK(large.width() == 3 * small.width());
  const auto mean = [](const Image<Rgba8>& picture) {
    glm::dvec3 sum(0);
    for (const Rgba8& c : picture.pixels()) sum += glm::dvec3(c[0], c[1], c[2]);
    return sum / static_cast<double>(picture.size());
  };
  CHECK(glm::length(mean(large) - mean(small)) < 3);
  app.frames(2);
  CHECK(app.window("##Tooltip_00").size() == tip.size());
  const auto& views = app.studio().cuts().run(app.studio().document().active)->views;
  const UiRect last = app.button("side " + std::to_string(views.size() - 1));
  app.move(0.5f * (last.min + last.max));
  app.frames(3);
  CHECK(app.window("##Tooltip_00").max.y <= app->interface().viewport().max.y);  // not over the status bar
  app.move({500, 400});
  app.frames(3);
  CHECK(app.window("##Tooltip_00").size() == glm::vec2(0));
}

TEST_CASE(
    "ui: what shows a thumbnail larger goes once it is clicked, and comes back where the pointer moves") {
  HeadlessApp app(1360, 860);
  app.interface_state().hint_wanted = false;
  REQUIRE(cut_out_apple(app));
  app.wait_for_message_to_go();
  const auto tip = [&] { return app.window("##Tooltip_00").size(); };
  const UiRect card = app.button("side 1");
  const glm::vec2 middle = 0.5f * (card.min + card.max);
  app.move(middle);
  app.frames(3);
  REQUIRE(tip() != glm::vec2(0));
  const CameraPose before = app.studio().camera().goal();
  app.click(middle);
  app.frames(3);
  CHECK(app.studio().camera().goal() != before);
  CHECK(tip() == glm::vec2(0));
  REQUIRE(app.settle());
  app.frames(3);
  CHECK(tip() == glm::vec2(0));
  app.move(middle + glm::vec2(3, 0));
  app.frames(3);
  CHECK(tip() != glm::vec2(0));
}

TEST_CASE("ui: no row of the right panel moves as doubts, progress and times come and go") {
  for (const bool small : {false, true}) {
    CAPTURE(small);
    HeadlessApp app(small ? 800 : 1000, small ? 600 : 860);
    app.interface_state().hint_wanted = false;
    REQUIRE(cut_out_apple(app));
    if (!small) app.press_item("side/scroll", {"Repair by hand"});
    const UiRect view = app->interface().viewport();
    const auto apple = app.studio().viewport().pick(app.screen_of(kOnApple) - view.min);
    REQUIRE(apple);
    const glm::vec2 away = view.min + glm::vec2(40, 200);  // nothing of the panel is aimed at
    app.move(away);
    REQUIRE(app.settle());
    const auto doubted = [&] {
      const CutRun* run = app.studio().cuts().run(app.studio().document().active);
      return run && !run->doubts.empty();
    };
    const auto rows = [&] {
      app.frames(3);
      std::vector<ShownItem> items = app.interface_state().items;
      std::erase_if(items, [](const ShownItem& i) { return i.name != icon::kRefresh && i.name != "Grow"; });
      return items;
    };
    REQUIRE_FALSE(doubted());
    const std::vector<ShownItem> certain = rows();
    REQUIRE(certain.size() == (small ? 1 : 2));
    app.studio().camera().zoom(-45, apple->position_world);
    REQUIRE(app.settle());
    app.key('N', {.ctrl = true});
    const Camera far = app.studio().viewport().pane_camera();
    app.click(view.min + far.pixel_from_camera(far.camera_from_world(apple->position_world)));
    app.move(away);
    const std::vector<ShownItem> running = rows();  // a row lower: there are two objects
    REQUIRE(app.studio().cutting());
    REQUIRE(app.settle());
    REQUIRE(doubted());
    CHECK(rows() == running);
    app.studio().apply(ActivateObject{app.studio().document().objects.front().id});
    REQUIRE_FALSE(doubted());
    CHECK(rows() == running);
    for (const bool again : {false, true}) {
      app.studio().apply(again ? Command(Redo{}) : Command(Undo{}));
      REQUIRE(app.settle());
      CHECK((rows() == running || rows() == certain));
    }
  }
}

TEST_CASE(
    "ui: in a window of 800 by 600 the slider of smoothness is in sight, or a bar says that one scrolls") {
  HeadlessApp app(800, 600);
  app.interface_state().hint_wanted = false;
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const auto panel = [&]() -> const ImGuiWindow& {
    app->interface().make_current();
    const auto found = std::ranges::find_if(GImGui->Windows, [](const ImGuiWindow* w) {
      return w->WasActive && std::string_view(w->Name).find("side/scroll") != std::string_view::npos;
    });
    REQUIRE(found != GImGui->Windows.end());
    return **found;
  };
  const auto apple = app.studio().viewport().pick(app.screen_of(kOnApple) - app->interface().viewport().min);
  REQUIRE(apple);
  app.studio().camera().zoom(-45, apple->position_world);
  REQUIRE(app.settle());
  for (int objects = 1; objects <= 8; ++objects) {
    CAPTURE(objects);
    app.key('N', {.ctrl = true});
    if (objects == 1 || objects == 8) {
      const Camera far = app.studio().viewport().pane_camera();
      app.click(app->interface().viewport().min +
                far.pixel_from_camera(far.camera_from_world(apple->position_world)));
    }
    REQUIRE(app.settle());
    app.frames(3);
    const CutRun* run = app.studio().cuts().run(app.studio().document().active);
    if (run) {
      REQUIRE_FALSE(run->doubts.empty());
      CHECK(app.button("Come nearer").max.y <= 600 - 30);
    }
    const ImGuiWindow& rows = panel();
    const UiRect refresh = app.button(icon::kRefresh);
    REQUIRE(refresh.size().x > 0);
    CHECK((refresh.max.y <= rows.InnerClipRect.Max.y || rows.ScrollbarY));
    CHECK(rows.Size.y > 250);
  }
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
