// The program by keys alone: the cursor in the picture that arrows move, Tab through all that can be pressed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr Modifiers kShift{.shift = true}, kAlt{.alt = true}, kCtrl{.ctrl = true};

// Presses arrows until the cursor is at a place of the screen, to the point.
void walk_to(Hands& hands, const glm::vec2& screen) {
  const auto cursor = [&] { return *hands.studio().cursor_px(); };
  if (!hands.studio().cursor_px()) hands.app.key(key::kRight);
  const glm::vec2 goal = glm::round(hands.in_viewport(screen) - cursor()) + cursor();
  for (const auto& [points, held] : {std::pair(40.0f, kShift), {8.0f, Modifiers{}}, {1.0f, kAlt}})
    for (int axis = 0; axis < 2; ++axis) {
      const auto missing = [&] { return goal[axis] - cursor()[axis]; };
      const int forward = axis == 0 ? key::kRight : key::kDown, back = axis == 0 ? key::kLeft : key::kUp;
      while (std::abs(missing()) >= points) hands.app.key(missing() > 0 ? forward : back, held);
    }
  REQUIRE(cursor() == goal);
}

std::vector<std::uint8_t> labels_of(Hands& hands) {
  REQUIRE(hands.app.settle());
  return hands.studio().labels(hands.studio().document().active);
}

glm::vec2 cursor_on_screen(Hands& hands) {
  return hands.app->interface().viewport().min + *hands.studio().cursor_px();
}

// The corner of what Tab has marked.
using Corner = std::pair<float, float>;
std::optional<Corner> marked(Hands& hands) {
  hands.app.frames(12);  // it looks for the next one
  const auto& mark = hands.app.interface_state().marked;
  return mark ? std::optional(Corner(mark->min.x, mark->min.y)) : std::nullopt;
}

// What Tab comes by until it is where it began: items, and their corners.
struct Round {
  std::vector<ImGuiID> items;
  std::vector<Corner> corners;
};
Round round_by_tab(Hands& hands, const Modifiers& held) {
  Round round;
  for (;;) {
    hands.app.key(key::kTab, held);
    const std::optional<Corner> corner = marked(hands);
    REQUIRE(corner);
    if (!round.items.empty() && GImGui->NavId == round.items.front()) return round;
    round.items.push_back(GImGui->NavId);
    round.corners.push_back(*corner);
    REQUIRE(round.items.size() < 200);
  }
}

// Presses Tab until a button is marked, by what stands on it.
void tab_to(Hands& hands, std::string_view name) {
  for (int i = 0; i < 100; ++i) {
    hands.app.key(key::kTab);
    const std::optional<Corner> corner = marked(hands);
    const UiRect button = hands.app.button(name);
    if (corner == Corner(button.min.x, button.min.y)) return;
  }
  FAIL("Tab does not come to ", std::string(name));
}

}  // namespace

TEST_CASE("keyboard: no message hides the cursor") {
  Hands hands(false);
  const UiRect area = hands.app->interface().viewport();
  walk_to(hands, {area.min.x + 60, area.max.y - 34});
  hands.app.key('I');  // there is no object: a message says so
  REQUIRE(hands.said().find("Click an object first") != std::string::npos);
  const Image<Rgb8> picture = hands.app.picture();
  const glm::ivec2 at(cursor_on_screen(hands));
  for (const glm::ivec2 arm : {glm::ivec2(12, 0), {-12, 0}, {0, 12}, {0, -12}}) {
    CAPTURE(arm.x);
    CAPTURE(arm.y);
    const Rgb8 c = picture.at(at.x + arm.x, at.y + arm.y);
    CHECK(std::min({c[0], c[1], c[2]}) > 200);
  }
}

TEST_CASE(
    "keyboard: an arrow shows a cursor in the middle, or at the mouse; steps are as long as the keys say") {
  Hands hands(false);
  const Studio& studio = hands.studio();
  CHECK_FALSE(studio.cursor_px());
  const UiRect area = hands.app->interface().viewport();
  hands.app.key(key::kRight);
  REQUIRE(studio.cursor_px());
  CHECK(glm::distance(*studio.cursor_px(), 0.5f * area.size() + glm::vec2(8, 0)) < 1.5f);
  const auto step = [&](int code, const Modifiers& held) {
    const glm::vec2 before = *studio.cursor_px();
    hands.app.key(code, held);
    return *studio.cursor_px() - before;
  };
  CHECK(step(key::kLeft, {}) == glm::vec2(-8, 0));
  CHECK(step(key::kUp, kShift) == glm::vec2(0, -40));
  CHECK(step(key::kDown, kAlt) == glm::vec2(0, 1));
  const CameraPose pose = studio.camera().pose();
  for (int i = 0; i < 40; ++i) hands.app.key(key::kDown, kShift);
  for (int i = 0; i < 40; ++i) hands.app.key(key::kRight, kShift);
  CHECK(*studio.cursor_px() == area.size() - glm::vec2(1));  // it stays in the picture
  CHECK(studio.camera().pose().position_world == pose.position_world);
  const glm::vec2 mouse = area.min + glm::vec2(100, 90);
  hands.app.move(mouse);
  CHECK_FALSE(studio.cursor_px());
  hands.app.key(key::kDown);
  CHECK(*studio.cursor_px() == glm::vec2(100, 98));
}

TEST_CASE("keyboard: Enter cuts what a click at the cursor cuts, Ctrl+Enter what a right click does") {
  Hands keys(false), mouse(false);
  walk_to(keys, keys.app.screen_of(kOnApple));
  const glm::vec2 on_apple = cursor_on_screen(keys);
  keys.app.key(key::kEnter);
  mouse.app.click(on_apple);
  const auto apple = labels_of(keys);
  CHECK(std::ranges::count(apple, 1) > 20);
  CHECK(apple == labels_of(mouse));
  CHECK(keys.studio().cursor_px());  // for the next click
  walk_to(keys, keys.app.screen_of(kOnApple) + glm::vec2(0, -9));
  const glm::vec2 above = cursor_on_screen(keys);
  keys.app.key(key::kEnter, kCtrl);
  mouse.app.click(above, PointerButton::kRight);
  CHECK(labels_of(keys) == labels_of(mouse));
  const StrokedView& view = keys.studio().document().active_object()->views.back();
  CHECK(view.strokes.back().label == SeedLabel::kRest);
}

TEST_CASE("keyboard: what Enter would take is outlined, until Esc or the mouse hides the cursor") {
  for (const bool by_mouse : {false, true}) {
    Hands hands(false);
    walk_to(hands, hands.app.screen_of(kOnApple));
    REQUIRE(hands.app.settle());
    hands.app.frames(2);
    const Flags outlined = hands.studio().viewport().style(0).highlight;
    REQUIRE(outlined);
    CHECK(count_flags(*outlined) > 20);
    if (by_mouse)
      hands.app.move({5, kHandsHeight - 5});
    else
      hands.app.key(key::kEscape);
    REQUIRE(hands.app.settle());
    CHECK_FALSE(hands.studio().cursor_px());
    CHECK(hands.studio().view().tool == Tool::kClick);
    CHECK_FALSE(hands.studio().viewport().style(0).highlight);
    const auto before = hands.studio().messages().size();
    hands.app.key(key::kEnter);  // nothing to click at
    CHECK(hands.studio().document().objects.empty());
    CHECK(hands.studio().messages().size() == before + 1);
  }
}

TEST_CASE("keyboard: Enter begins what a drag draws, arrows draw it, Enter ends it, Esc drops it") {
  Hands keys(false), mouse(false);
  const glm::vec2 from = keys.app.screen_of(kOnApple) - glm::vec2(30, 30);
  keys.app.key('7');
  mouse.app.key('7');
  walk_to(keys, from);
  const glm::vec2 corner = cursor_on_screen(keys);
  keys.app.key(key::kEnter);
  CHECK(keys.studio().cursor_draws());
  walk_to(keys, from + glm::vec2(60, 50));
  keys.app.key(key::kEscape);
  CHECK_FALSE(keys.studio().cursor_draws());
  CHECK(keys.studio().cursor_px());
  CHECK_FALSE(keys.studio().tools().dragging());
  CHECK(keys.selected() == 0);
  walk_to(keys, from);
  keys.app.key(key::kEnter);
  walk_to(keys, from + glm::vec2(60, 50));
  const glm::vec2 opposite = cursor_on_screen(keys);
  keys.app.key(key::kEnter);
  CHECK(keys.selected() > 20);
  mouse.app.drag({corner, opposite});
  CHECK(labels_of(keys) == labels_of(mouse));
}

TEST_CASE("keyboard: a mouse that moves takes over from a shape that arrows draw") {
  Hands hands(false);
  hands.app.key('7');
  walk_to(hands, hands.app.screen_of(kOnApple));
  hands.app.key(key::kEnter);
  hands.app.key(key::kRight, kShift);
  const glm::vec2 from = hands.app.screen_of(kOnApple) - glm::vec2(30, 30);
  hands.app.move(from);
  CHECK_FALSE(hands.studio().tools().dragging());
  hands.app.drag({from, from + glm::vec2(60, 50)});
  CHECK(hands.selected() > 20);
}

TEST_CASE("keyboard: Enter sets the corners of a polygon, a second one at the last corner closes it") {
  Hands hands(false);
  hands.app.key('8');
  const glm::vec2 middle = hands.app.screen_of(kOnApple);
  for (const glm::vec2& corner : {glm::vec2(-35, -30), {35, -30}, {0, 35}}) {
    walk_to(hands, middle + corner);
    hands.app.key(key::kEnter);
  }
  CHECK(hands.selected() == 0);
  hands.app.key(key::kEnter);
  CHECK(hands.selected() > 20);
}

TEST_CASE("keyboard: the cursor is drawn where it clicks") {
  Hands hands(false);
  hands.app.wait_for_message_to_go();
  const Image<Rgb8> without = hands.app.picture();
  walk_to(hands, hands.app->interface().viewport().min + glm::vec2(60, 200));
  hands.studio().run(Action::kToolNavigate);  // no outline of a click
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  const Image<Rgb8> with = hands.app.picture();
  const glm::ivec2 at(cursor_on_screen(hands));
  std::size_t near = 0, inside = 0;
  for (int y = -20; y <= 20; ++y)
    for (int x = -20; x <= 20; ++x) {
      const bool differs = with.at(at.x + x, at.y + y) != without.at(at.x + x, at.y + y);
      near += differs;
      inside += differs && x * x + y * y < 16;
    }
  CHECK(near > 80);
  CHECK(inside == 0);  // what is clicked stays in sight
}

TEST_CASE("keyboard: Tab comes by all that can be pressed, Shift+Tab the other way") {
  Hands hands;
  hands.app->resize({kHandsWidth, kHandsHeight + 200}, 1);  // the panel need not scroll
  hands.app.wait_for_message_to_go();
  const Round round = round_by_tab(hands, {});
  const std::vector<ShownItem>& items = hands.app.interface_state().items;
  std::set<std::string> passed_over;
  for (const ShownItem& item : items)
    if (item.name != "picture" && !std::ranges::count(round.corners, Corner(item.min.x, item.min.y)))
      passed_over.insert(item.name);
  // Nothing was undone, and the smoothness is the usual one.
  CHECK(passed_over == std::set<std::string>{icon::kRedo, icon::kRefresh});
  CHECK(round.items.size() > items.size() + tools().size());  // sections, sliders and cards, too
  CHECK(std::set(round.items.begin(), round.items.end()).size() == round.items.size());
  hands.app.click({5, kHandsHeight + 195});
  for (int i = 0; i < 3; ++i) {  // faster than frames
    hands.app->handle(KeyChanged{key::kTab, true, false, {}});
    hands.app->handle(KeyChanged{key::kTab, false, false, {}});
  }
  CHECK(marked(hands) == round.corners[2]);
  std::vector<ImGuiID> back = round_by_tab(hands, kShift).items;
  std::ranges::reverse(back);
  const auto first = std::ranges::find(back, round.items.front());
  REQUIRE(first != back.end());
  std::ranges::rotate(back, first);
  CHECK(back == round.items);
}

TEST_CASE("keyboard: in the export dialog, Tab comes by every button") {
  Hands hands;
  hands.app.key('E', {.ctrl = true});
  hands.app.frames(3);
  REQUIRE(hands.app.interface_state().export_open);
  const Round round = round_by_tab(hands, {});
  for (const std::string name : {"Everything else", ".spz", "Its foot", "+Y", "+Z", "Cancel", "Export"}) {
    CAPTURE(name);
    const auto& items = hands.app.interface_state().items;
    const auto comes_by = [&](const ShownItem& item) {  // the tool bar has an Export, too
      return item.name == name && std::ranges::count(round.corners, Corner(item.min.x, item.min.y)) == 1;
    };
    CHECK(std::ranges::count_if(items, comes_by) == 1);
  }
  CHECK(std::set(round.items.begin(), round.items.end()).size() == round.items.size());
}

TEST_CASE("keyboard: in the file dialog Tab comes to Save before Cancel, and Enter in the name saves") {
  const ScratchFolder folder("tab_in_files");
  Hands hands;
  hands.app.key('S', kCtrl);
  hands.app.frames(3);
  FileBrowser& files = hands.app.interface_state().files;
  REQUIRE(files.open);
  const UiRect dialog = hands.app.window("###files");
  const Round round = round_by_tab(hands, {});
  const auto place = [&](std::string_view name) {
    for (const ShownItem& item : hands.app.interface_state().items)
      if (item.name == name && dialog.contains(item.min))
        return std::ranges::find(round.corners, Corner(item.min.x, item.min.y));
    return round.corners.end();
  };
  const auto pressed = place("Save"), cancelled = place("Cancel");
  REQUIRE(pressed != round.corners.end());
  REQUIRE(cancelled != round.corners.end());
  CHECK(pressed + 1 == cancelled);
  CHECK(cancelled->first < pressed->first);
  for (int i = 0; i < 3 && files.open; ++i) hands.app.key(key::kEscape);
  REQUIRE_FALSE(files.open);
  hands.app.key('S', kCtrl);
  hands.app.frames(3);
  files.enter(folder.path());
  hands.app.type("mine");
  hands.app.key(key::kEnter);
  REQUIRE(hands.app.settle());
  CHECK_FALSE(files.open);
  CHECK(std::filesystem::exists(folder / "mine.splatcut.json"));
}

TEST_CASE("keyboard: Tab passes over the picture of the export dialog, and comes to Export before Cancel") {
  for (const int width : {1040, 760}) {  // the picture beside the fields, or a small one among them
    CAPTURE(width);
    Hands hands;
    hands.app->resize({width, kHandsHeight}, 1);
    hands.app.key('E', {.ctrl = true});
    hands.app.frames(3);
    REQUIRE(hands.app.interface_state().export_open);
    const UiRect dialog = hands.app.window("###export");
    const Round round = round_by_tab(hands, {});
    CHECK(std::ranges::count(round.items, ImHashStr("##preview", 0, GImGui->NavWindow->ID)) == 0);
    const auto place = [&](std::string_view name) {
      for (const ShownItem& item : hands.app.interface_state().items)
        if (item.name == name && dialog.contains(item.min))
          return std::ranges::find(round.corners, Corner(item.min.x, item.min.y));
      return round.corners.end();
    };
    const auto pressed = place("Export"), cancelled = place("Cancel");
    REQUIRE(pressed != round.corners.end());
    REQUIRE(cancelled != round.corners.end());
    CHECK(pressed + 1 == cancelled);
    CHECK(cancelled->first < pressed->first);  // they stand where they stood
  }
}

TEST_CASE(
    "keyboard: Enter and Space press what Tab has marked; Esc, the mouse and arrows take the mark away") {
  Hands hands;
  Studio& studio = hands.studio();
  for (const int code : {int(key::kEnter), int(' ')}) {
    const bool tint = studio.view().tint;
    tab_to(hands, icon::kTint);
    hands.app.key(code);
    hands.app.frames(3);
    CHECK(studio.view().tint == !tint);
  }
  const Tool& tool = tool_of(studio.view().tool);
  hands.app.key(key::kEscape);
  CHECK_FALSE(marked(hands));
  CHECK(tool_of(studio.view().tool) == tool);
  hands.app.key(key::kTab);
  CHECK(marked(hands));
  hands.app.click({5, kHandsHeight - 5});
  CHECK_FALSE(marked(hands));
  tab_to(hands, icon::kTint);
  const std::size_t strokes = studio.document().active_object()->views.size();
  walk_to(hands, hands.app.screen_of(kOnOrange));
  CHECK_FALSE(marked(hands));
  const bool tint = studio.view().tint;
  hands.app.key(key::kEnter);
  CHECK(studio.view().tint == tint);
  CHECK(studio.document().active_object()->views.size() + studio.document().objects.size() > strokes);
}

TEST_CASE("keyboard: a field that Tab comes to takes what is typed, and Tab goes on") {
  Hands hands;
  ImGuiIO& io = ImGui::GetIO();
  for (int i = 0; i < 100 && !io.WantTextInput; ++i) {
    hands.app.key(key::kTab);
    marked(hands);
  }
  REQUIRE(io.WantTextInput);
  const std::optional<Corner> field = marked(hands);
  hands.app->handle(TextTyped{'7'});
  hands.app.frames(2);
  hands.app.key(key::kTab);
  CHECK(marked(hands) != field);
  CHECK_FALSE(io.WantTextInput);
  CHECK(hands.studio().document().active_object()->smoothness == 7);
}

TEST_CASE("keyboard: in the settings Tab comes by what is in them alone, and Enter presses that") {
  Hands hands(false);
  hands.app.key(',', kCtrl);
  hands.app.frames(3);
  const UiRect page = hands.app.window("Settings");
  const std::vector<Corner> corners = round_by_tab(hands, {}).corners;
  CHECK(corners.size() == 12);  // two themes, the two sizes that fit, two sliders, three boxes, ...
  for (const Corner& p : corners) CHECK(page.contains({p.first, p.second}));
  tab_to(hands, "Light");
  hands.app.key(key::kEnter);
  hands.app.frames(3);
  CHECK_FALSE(hands.app.interface_state().dark);
  CHECK(hands.app->interface().dialog_open());
  hands.app.key(key::kEscape);
  CHECK_FALSE(marked(hands));
  CHECK(hands.app->interface().dialog_open());
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  CHECK_FALSE(hands.app->interface().dialog_open());
}

TEST_CASE("keyboard: Esc takes the mark in the export dialog away first, and the typed name stays") {
  Hands hands;
  hands.app.key('E', kCtrl);
  hands.app.frames(3);
  hands.app.type("pear");
  const std::string typed = hands.app.interface_state().exporting.path;
  REQUIRE(typed.ends_with("pear.ply"));
  tab_to(hands, "Its middle");
  hands.app.key(key::kEscape);
  CHECK_FALSE(marked(hands));
  REQUIRE(hands.app.interface_state().export_open);
  CHECK(hands.app.interface_state().exporting.path == typed);
  hands.app.key(key::kEscape);
  hands.app.frames(3);
  CHECK_FALSE(hands.app.interface_state().export_open);
}
