// What is typed into fields of dialogs and panels.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>

#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("dialogs: Enter and Esc in a number end the number, not the dialog") {
  const ScratchFolder folder("numbers");
  HeadlessApp app(760, 520);
  REQUIRE(cut_out_apple(app));
  UiState& state = app.interface_state();
  app.key('E', {.ctrl = true});
  app.frames(3);
  app->interface().make_current();
  ImGui::ClearActiveID();  // the name is being typed
  state.exporting.path = (folder / "object.ply").string();
  app.type_into("###export", {"##turn"}, "30");
  app.key(key::kEnter);
  app.frames(3);
  CHECK(state.exporting.placement.turn_deg == 30);
  CHECK(app->interface().dialog_open());
  app.type_into("###export", {"##scale"}, "3");
  app.key(key::kEscape);
  app.frames(3);
  CHECK(state.exporting.placement.scale == 1);
  CHECK(app->interface().dialog_open());
  app.type_into("###export", {"##path"}, (folder / "turned.ply").string());
  app.key(key::kEnter);
  REQUIRE(app.settle());
  CHECK_FALSE(app->interface().dialog_open());
  CHECK_FALSE(std::filesystem::exists(folder / "object.ply"));
  CHECK(std::filesystem::exists(folder / "turned.ply"));
  state.turntable_open = true;
  app.frames(3);
  app.type_into("###turntable", {"##frames"}, "5");
  app.key(key::kEnter);
  app.frames(3);
  CHECK(state.turntable.frames == 5);
  CHECK(app->interface().dialog_open());
  app.type_into("###turntable", {"##width"}, "77");
  app.key(key::kEscape);
  app.frames(3);
  CHECK(state.turntable.width_px != 77);
  CHECK(app->interface().dialog_open());
  app.key(key::kEscape);
  app.frames(3);
  CHECK_FALSE(app->interface().dialog_open());
}

TEST_CASE("dialogs: keys that are pressed and released between two frames count, in their order") {
  const ScratchFolder folder("quick");
  HeadlessApp app(760, 520);
  REQUIRE(cut_out_apple(app));
  app.key('E', {.ctrl = true});
  app.frames(3);
  app.type_into("###export", {"##path"}, "/wrong");
  const auto tap = [&](int code, const Modifiers& modifiers = {}) {
    app->handle(KeyChanged{code, true, false, modifiers});
    app->handle(KeyChanged{code, false, false, modifiers});
  };
  app->handle(KeyChanged{key::kLeftControl, true, false, {}});
  tap('A', {.ctrl = true});
  app->handle(KeyChanged{key::kLeftControl, false, false, {.ctrl = true}});
  const auto type = [&](const std::string& text) {
    for (const char c : text) {
      app->handle(KeyChanged{c, true, false, {}});
      app->handle(TextTyped{static_cast<unsigned>(c)});
      app->handle(KeyChanged{c, false, false, {}});
    }
  };
  type((folder / "right.ply").string());
  tap(key::kEnter);
  app.frames(5);
  CHECK(app.interface_state().exporting.path == (folder / "right.ply").string());
  tap(key::kEnter);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "right.ply"));
  // A button that is pressed after the name comes after it.
  app.key('E', {.ctrl = true});
  app.frames(3);
  const UiRect dialog = app.window("###export");
  const auto& items = app.interface_state().items;
  const auto button = std::ranges::find_if(
      items, [&](const ShownItem& i) { return i.name == "Export" && dialog.contains(i.min); });
  REQUIRE(button != items.end());
  const glm::vec2 on_button = 0.5f * (button->min + button->max);
  app.type_into("###export", {"##path"}, "/wrong");
  app->handle(KeyChanged{key::kLeftControl, true, false, {}});
  tap('A', {.ctrl = true});
  app->handle(KeyChanged{key::kLeftControl, false, false, {.ctrl = true}});
  type((folder / "pressed.ply").string());
  app.move(on_button);
  app.press(PointerButton::kLeft);
  app.release(PointerButton::kLeft);
  REQUIRE(app.settle());
  app.frames(4);
  REQUIRE(app.settle());
  CHECK(std::filesystem::exists(folder / "pressed.ply"));
}

TEST_CASE("dialogs: Tab right after letters comes after them, also behind one with Shift") {
  HeadlessApp app(1040, 600);
  REQUIRE(cut_out_apple(app, kSmallSample));
  UiState& state = app.interface_state();
  app.key('E', {.ctrl = true});
  app.frames(3);
  const std::filesystem::path before = state.exporting.path;
  // As they come while a frame takes long: all between two of them, `_` with Shift.
  const auto tap = [&](int code, unsigned letter) {
    app->handle(KeyChanged{code, true, false, {}});
    if (letter) app->handle(TextTyped{letter});
    app->handle(KeyChanged{code, false, false, {}});
  };
  for (const char c : std::string("burger")) tap(std::toupper(c), static_cast<unsigned>(c));
  app->handle(KeyChanged{key::kLeftShift, true, false, {}});
  app->handle(KeyChanged{'-', true, false, {.shift = true}});
  app->handle(TextTyped{'_'});
  app->handle(KeyChanged{'-', false, false, {.shift = true}});
  app->handle(KeyChanged{key::kLeftShift, false, false, {.shift = true}});
  for (const char c : std::string("keys")) tap(std::toupper(c), static_cast<unsigned>(c));
  tap(key::kTab, 0);
  app.frames(12);
  CHECK(std::filesystem::path(state.exporting.path) == before.parent_path() / "burger_keys.ply");
  CHECK_FALSE(ImGui::GetIO().WantTextInput);  // it went on
  CHECK(state.marked);
  CHECK(app->interface().dialog_open());
}

TEST_CASE(
    "dialogs: what is typed right after Tab is for the field that Tab comes to, and Enter for its button") {
  HeadlessApp app(1040, 600);
  REQUIRE(cut_out_apple(app, kSmallSample));
  UiState& state = app.interface_state();
  app.key('E', {.ctrl = true});
  app.frames(3);
  const auto tap = [&](int code, unsigned letter = 0) {
    app->handle(KeyChanged{code, true, false, {}});
    if (letter) app->handle(TextTyped{letter});
    app->handle(KeyChanged{code, false, false, {}});
  };
  app.type_into("###export", {"##x"}, "");
  for (const char number : {'4', '5', '6'}) {
    if (number != '4') tap(key::kTab);
    tap(number, static_cast<unsigned>(number));
  }
  tap(key::kTab);
  app.frames(20);
  const glm::vec3 in_file = state.exporting.format.axes.position(state.exporting.placement.move);
  CHECK(in_file == glm::vec3(4, 5, 6));
  app.type_into("###export", {"##path"}, "/nowhere/mine");
  tap(key::kTab);
  tap(key::kEnter);
  app.frames(12);
  CHECK_FALSE(app.studio().exporting());
  CHECK_FALSE(state.export_open);
  CHECK(app.window("###files").size().x > 0);  // the button behind the name, and not Export
}

TEST_CASE("panels: a number is typed in the unit it is shown in") {
  HeadlessApp app(900, 1300);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  const ViewState& view = app.studio().view();
  const float size = app.studio().camera().scene_size();
  const auto typed = [&](const char* window, std::initializer_list<const char*> names, float value) {
    app.type_into(window, names, fmt::format("{:.5f}", value));
    app.key(key::kEnter);
    app.frames(3);
  };
  const char* side = "side/scroll";
  app.press_item(side, {"View"});
  app.press_item(side, {"Repair by hand"});
  const float near_plane = 3 * app.studio().viewport().draw_limits().near_plane;
  typed(side, {"##near"}, near_plane);
  CHECK(app.studio().viewport().draw_limits().near_plane == doctest::Approx(near_plane).epsilon(1e-3));
  typed(side, {"##far"}, 1.5f * size);
  CHECK(app.studio().viewport().draw_limits().far_plane == doctest::Approx(1.5f * size).epsilon(1e-3));
  PropertyChoice& property = app.interface_state().property;
  property.property = 0;
  app.frames(2);
  typed(side, {"##range", "##min"}, 30);
  CHECK(property.low == doctest::Approx(0.3f).epsilon(1e-3));
  property.property = 1;
  app.frames(2);
  typed(side, {"##range", "##max"}, 0.02f);
  CHECK(property.high == doctest::Approx(std::log10(0.02f)).epsilon(1e-3));
  property.property = PropertyChoice::kColourProperty;
  app.frames(2);
  typed(side, {"##tolerance"}, 25);
  CHECK(property.tolerance == doctest::Approx(0.25f));
  app.key('C');
  app.frames(2);
  typed("options", {"##tolerance"}, 35);  // below the bar, which has no room for them here
  CHECK(view.colour_tolerance == doctest::Approx(0.35f));
  app.key('7');
  app.key('V');
  app.frames(2);
  REQUIRE(view.see_through);
  typed("options", {"##depth"}, 0.125f * size);
  CHECK(view.depth_limit == doctest::Approx(0.125f).epsilon(1e-3));
}
