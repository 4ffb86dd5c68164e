// What the window remembers between runs.
#include <doctest/doctest.h>

#include <fstream>

#include "app/window/settings.h"
#include "app/window/window_place.h"
#include "core/error.h"
#include "headless_app.h"
#include "quick.h"

using namespace splatcut;
using namespace splatcut::testing;

QUICK_CASE("settings",
           "settings: written and read back the same, and what cannot be read is as good as none") {
  const ScratchFolder place("settings");
  const std::filesystem::path file = place / "deeper/settings.json";
  CHECK(load_settings(file).width == Settings{}.width);
  Settings settings;
  settings.width = 1200;
  settings.height = 700;
  settings.position = {-1280, 35};  // a screen to the left of the first
  settings.maximized = true;
  settings.dark = false;
  settings.view.web_low_pass = true;
  settings.view.fly_speed = 2.5f;
  settings.ui_scale = 1.25f;
  settings.recent = {place.path()};
  settings.export_folder = place / "exported";
  save_settings(file, settings);
  const Settings read = load_settings(file);
  CHECK(read.width == 1200);
  CHECK(read.height == 700);
  REQUIRE(read.position);
  CHECK(*read.position == glm::ivec2(-1280, 35));
  CHECK(read.maximized);
  CHECK_FALSE(read.dark);
  CHECK(read.view.web_low_pass);
  CHECK(read.view.fly_speed == 2.5f);
  CHECK(read.ui_scale == 1.25f);
  CHECK(read.recent == settings.recent);
  CHECK(read.export_folder == settings.export_folder);
  settings.position.reset();
  save_settings(file, settings);
  CHECK_FALSE(load_settings(file).position);
  for (const char* text : {"{", "[]", R"({"position": 3})", R"({"position": [1]})", R"({"width": "wide"})"}) {
    std::ofstream(file, std::ios::trunc) << text;
    CHECK_FALSE(load_settings(file).position);
    CHECK(load_settings(file).width == Settings{}.width);
  }
}

QUICK_CASE("settings", "settings: kept as they change, and tried again where they could not be written") {
  const ScratchFolder place("settings_kept");
  const std::filesystem::path file = place / "settings.json";
  SettingsKeeper keeper(file);
  Settings now = keeper.kept();
  keeper.keep(now);
  CHECK_FALSE(std::filesystem::exists(file));  // nothing changed
  now.recent = {place.path()};
  keeper.keep(now);
  CHECK(load_settings(file).recent == now.recent);
  std::filesystem::remove(file);
  keeper.keep(now);
  CHECK_FALSE(std::filesystem::exists(file));
  std::filesystem::create_directories(file);  // in the way
  now.dark = false;
  CHECK_THROWS_AS(keeper.keep(now), Error);
  std::filesystem::remove(file);
  keeper.keep(now);
  CHECK_FALSE(load_settings(file).dark);
}

QUICK_CASE("settings", "settings: as in web viewers is the low-pass of what is drawn") {
  HeadlessApp app;
  CHECK(app.studio().viewport().draw_limits().low_pass_px2 == kLowPassPx2);
  ViewState view = app.studio().view();
  view.web_low_pass = true;
  app.studio().apply(SetView{view});
  CHECK(app.studio().viewport().draw_limits().low_pass_px2 == kWebLowPassPx2);
}

TEST_CASE("settings: what the page sets is what is kept, and what the next start begins with") {
  HeadlessApp app(1280, 800);
  app.frames(2);
  app.key(',', {.ctrl = true});
  REQUIRE(app->interface().dialog_open());
  UiState& state = app.interface_state();
  state.recent = {kSmallSample};
  app.press_item("Settings", {"Light"});
  CHECK_FALSE(state.dark);
  app.press_item("Settings", {"125 %"});
  CHECK(state.ui_scale == 1.25f);
  app.press_item("Settings", {"Tint"});
  app.press_item("Settings", {"Outline"});
  app.press_item("Settings", {"As in web viewers"});
  app.type_into("Settings", {"##speed"}, "3");
  app.key(key::kEnter);
  CHECK(app->interface().dialog_open());  // that was for the number
  app.type_into("Settings", {"##radius"}, "200");
  app.key(key::kEnter);
  app.press_item("Settings", {"Forget them"});
  app.key(key::kEscape);
  CHECK_FALSE(app->interface().dialog_open());

  Settings before;
  before.width = 1234;
  const Settings kept = settings_of(*app, before);
  CHECK(kept.width == 1234);
  CHECK_FALSE(kept.dark);
  CHECK(kept.ui_scale == 1.25f);
  CHECK_FALSE(kept.view.tint);
  CHECK_FALSE(kept.view.outline);
  CHECK(kept.view.web_low_pass);
  CHECK(kept.view.fly_speed == 3);
  CHECK(kept.view.brush_px == kMostBrushPx);
  CHECK(kept.recent.empty());
  HeadlessApp next(1280, 800);
  use_settings(kept, &*next);
  CHECK(settings_of(*next, before) == kept);
  next.open(kSmallSample);
  REQUIRE(next.settle());
  CHECK(next.studio().view().fly_speed == 3);  // of every scene
  CHECK_FALSE(next.studio().view().tint);

  next.key(',', {.ctrl = true});
  next.press_item("Settings", {"Reset all"});
  const Settings reset = settings_of(*next, before);
  CHECK(reset.dark);
  CHECK(reset.ui_scale == 1);
  CHECK(reset.view == ViewState());
  CHECK(reset.recent.size() == 1);
}

TEST_CASE("settings: the page is behind a button, fits the smallest window, and no size hides it") {
  HeadlessApp app(640, 480);
  app.frames(2);
  const UiRect gear = app.button(icon::kGear);
  REQUIRE(gear.size().x > 10);
  app.click(0.5f * (gear.min + gear.max));
  app.frames(4);
  REQUIRE(app->interface().dialog_open());
  for (const char* name : {"Light", "200 %", "Forget them", "Reset all", "Close"}) {
    CAPTURE(name);
    const UiRect button = app.button(name), page = app.window("Settings");
    CHECK(button.size().x > 10);
    CHECK(page.contains(button.min));
    CHECK(page.contains(button.max));
  }
  const auto press = [&](const char* name) {
    const UiRect button = app.button(name);
    app.click(0.5f * (button.min + button.max));
    app.frames(2);
  };
  press("125 %");
  CHECK(app.interface_state().ui_scale == 1);  // there is no room for it
  press("75 %");
  CHECK(app.interface_state().ui_scale == 0.75f);
}

TEST_CASE(
    "settings: a window comes back as large as it was on the screen it was on, where that is still there") {
  const Screen laptop{{0, 25}, {1440, 875}, {2, 2}}, large{{1440, 0}, {2560, 1440}};
  const Screen both[] = {laptop, large};
  const WindowPlace left{{2400, 1300}, glm::ivec2(1500, 60), false, false};
  CHECK(fitting(left, both).size == left.size);
  CHECK(fitting(left, both).position == left.position);
  const WindowPlace alone = fitting(left, std::span(both).first(1));
  CHECK_FALSE(alone.position);
  CHECK(alone.size == glm::ivec2(1400, 835));
  CHECK(fitting({{2400, 1300}, {}}, both).size == glm::ivec2(1400, 835));
  CHECK(fitting({{1440, 900}, {}, false, true}, both).size == glm::ivec2(700, 417));
  CHECK(fitting(left, {}).size == left.size);
}
