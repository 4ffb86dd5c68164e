// The right panel: it stays under the pointer, makes room for keys, follows the history.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>

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
