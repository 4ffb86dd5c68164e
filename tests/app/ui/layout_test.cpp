// Where the interface lies in windows of any size: nothing is cut off, and nothing runs into another.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "app/ui/panels.h"
#include "app/ui/theme.h"
#include "app/work/work_file.h"
#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

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
  for (const char* title : {"Files", "View", "Repair by hand"})  // each while it is in sight
    app.press_item("side/scroll", {title});
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  const float side = app->interface().viewport().max.x;
  CHECK(kWidth - side <= kWidth / 3 + 1);
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

TEST_CASE(
    "ui: in a small window the hint can be closed, and thumbnails leave rows of the panel their place") {
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
  app.frames(2);
  const UiRect cards = app.window("side/cards"), rows = app.window("side/scroll");
  CHECK(cards.min.x >= view.max.x);
  CHECK(cards.max.y <= view.max.y);
  CHECK(cards.size().y > 60);
  CHECK(cards.size().y < 0.36f * rows.size().y + 0.36f * cards.size().y);
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
  ApplicationOptions options = with_state(folder);
  options.sample = kSample;
  for (const auto& [width, height, scale] : {std::tuple(640, 480, 1.0f), std::tuple(800, 480, 1.0f),
                                             std::tuple(1280, 960, 2.0f), std::tuple(1280, 720, 1.0f)}) {
    CAPTURE(width);
    HeadlessApp app(width, height, scale, options);
    app.frames(4);
    const UiRect area = app->interface().viewport(), page = app.window("start");
    // The panel tells of a scene: a small window gives its room to the page until there is one.
    CHECK((area.max.x == static_cast<float>(width) / scale) == (static_cast<float>(width) / scale < 880));
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

TEST_CASE("ui: keys scroll the page of keys as soon as it is open") {
  HeadlessApp app(800, 600);
  app.frames(1);
  app.key(key::kF1);
  app.frames(3);
  app->interface().make_current();
  const auto page = [] {
    for (ImGuiWindow* w : GImGui->Windows)
      if (w->WasActive && std::string_view(w->Name).find("/keys") != std::string_view::npos) return w;
    return static_cast<ImGuiWindow*>(nullptr);
  };
  REQUIRE(page());
  REQUIRE(page()->ScrollMax.y > 0);
  float before = 0;
  const auto after = [&](int code) {
    before = page()->Scroll.y;
    app.key(code);
    app.frames(3);
    return page()->Scroll.y;
  };
  CHECK(after(key::kDown) > before);
  CHECK(after(key::kPageDown) > before);
  CHECK(after(key::kEnd) == page()->ScrollMax.y);
  CHECK(after(key::kPageUp) < before);
  CHECK(after(key::kUp) <= before);
  CHECK(after(key::kHome) == 0);
}

TEST_CASE(
    "ui: nothing of a tool's options moves as it is switched to see through, in a window of any width") {
  for (const int width : {640, 880, 1000, 1200, 1400, 1600, 1800}) {
    CAPTURE(width);
    HeadlessApp app(width, 480);
    app.interface_state().hint_wanted = false;
    app.open(kSmallSample);
    REQUIRE(app.settle());
    for (const Tool* tool : tools()) {
      if (tool->selects != Tool::Selects::kPixels) continue;
      const std::string named = tool->name;
      CAPTURE(named);
      ViewState view = app.studio().view();
      const auto items_with = [&](bool through) {
        view.tool = *tool;
        view.see_through = through;
        view.depth_limit = 0;
        app.studio().apply(SetView{view});
        app.frames(4);
        return app.interface_state().items;
      };
      const std::vector<ShownItem> before = items_with(false), after = items_with(true);
      for (const ShownItem& item : before)
        CHECK_MESSAGE(std::ranges::count(after, item) > 0, item.name << " moved");
      // The limit of depth came where there is room for it.
      app->interface().make_current();
      const bool below = ImGui::FindWindowByName("options") && ImGui::FindWindowByName("options")->WasActive;
      for (const char* window : {"bar", "options"})
        if (below || window == std::string_view("bar")) {
          app.type_into(window, {"##depth"}, "0.5");
          app.key(key::kEnter);
        }
      CHECK(app.studio().view().depth_limit > 0);
      if (below) {
        CHECK(ImGui::FindWindowByName("options")->ScrollMax.x == 0);
        CHECK(ImGui::FindWindowByName("options")->ScrollMax.y == 0);
      }
    }
  }
}

TEST_CASE("ui: a tooltip of the start page covers no entry of it") {
  for (const glm::ivec2& size : {glm::ivec2(640, 480), {1000, 700}}) {
    CAPTURE(size.x);
    ApplicationOptions options;
    options.sample = kSample;
    HeadlessApp app(size.x, size.y, 1, options);
    app.interface_state().recent = {kSample, kSmallSample, "/captures/garden/point_cloud/point_cloud.ply"};
    app.frames(3);
    const UiRect view = app->interface().viewport();
    const float row = ImGui::GetFrameHeight();
    std::size_t tips = 0;
    for (float y = view.min.y; y < view.max.y; y += 4) {
      const glm::vec2 at(0.5f * (view.min.x + view.max.x) - 190, y);
      app.move(at);
      app.frames(3);
      app->interface().make_current();
      const ImGuiWindow* tip = ImGui::FindWindowByName("##Tooltip_00");
      if (!tip || !tip->WasActive) continue;
      ++tips;
      // The entries stand below each other at the left of the page.
      CHECK_FALSE(tip->Rect().Overlaps({{at.x, at.y - row}, {at.x + 1, at.y + row}}));
    }
    CHECK(tips > 6);
  }
}

TEST_CASE("ui: a tooltip covers no other button of its bar, and lies within the window") {
  for (const glm::ivec2& size : {glm::ivec2(640, 480), {1000, 700}, {1400, 860}}) {
    CAPTURE(size.x);
    HeadlessApp app(size.x, size.y);
    app.interface_state().hint_wanted = false;
    app.open(kSmallSample);
    REQUIRE(app.settle());
    app.key('6');
    app.press_item("side/scroll", {"Repair by hand"});
    app.frames(2);
    const UiRect view = app->interface().viewport();
    // The window part that an item stands in: 0 the bar, 1 the right panel, 2 below the picture, 3 over it.
    const auto part_of = [&](const glm::vec2& at) {
      return at.y < view.min.y ? 0 : at.x > view.max.x ? 1 : at.y > view.max.y ? 2 : 3;
    };
    const auto tip_at = [&](const glm::vec2& at) {
      app.move(at);
      app.frames(3);
      app->interface().make_current();
      const ImGuiWindow* tip = ImGui::FindWindowByName("##Tooltip_00");
      return tip && tip->WasActive ? std::optional(tip->Rect()) : std::nullopt;
    };
    std::size_t tips = 0;
    for (const ShownItem& item : std::vector(app.interface_state().items)) {
      const int part = part_of(item.min);
      if (item.name == "picture" || part > 1 || item.max.y > view.max.y) continue;
      const std::optional<ImRect> tip = tip_at(0.5f * (item.min + item.max));
      if (!tip) continue;
      ++tips;
      CAPTURE(item.name);
      CHECK(tip->Min.x >= 0);
      CHECK(tip->Min.y >= 0);
      CHECK(tip->Max.x <= static_cast<float>(size.x));
      CHECK(tip->Max.y <= static_cast<float>(size.y));
      for (const ShownItem& other : app.interface_state().items)
        if (other.name != "picture" && part_of(other.min) == part)
          CHECK_MESSAGE(!tip->Overlaps({{other.min.x, other.min.y}, {other.max.x, other.max.y}}),
                        "covers " << other.name);
    }
    CHECK(tips > 15);
    const std::optional<ImRect> tool = tip_at({0.5f * view.min.x, view.min.y + 40});
    REQUIRE(tool);
    CHECK(tool->Min.x >= view.min.x);
  }
}

TEST_CASE("ui: in a small window the bar of other meanings says that Esc keeps what was taken") {
  HeadlessApp app(640, 480);
  app.interface_state().hint_wanted = false;
  app.open(kSample);
  REQUIRE(app.settle());
  app.click(app.screen_of({400, 210}));
  REQUIRE(app.settle());
  app.frames(2);
  REQUIRE(app.studio().clicks().offer());
  const std::string& words = app.interface_state().offer_words;
  for (const float width : {640.0f, 570.0f, 540.0f}) {  // a narrow one for two meanings is 640 for four
    CAPTURE(width);
    app->resize({width, 480}, 1);
    app.frames(2);
    CAPTURE(words);
    CHECK(words.find("what else this can mean") != std::string::npos);
    CHECK(words.find("Esc: keep this one") != std::string::npos);
  }
}

TEST_CASE("ui: in a window of 640 by 480 a message keeps its first words") {
  HeadlessApp app(640, 480);
  app.interface_state().hint_wanted = false;
  app.open(kSample);
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnOrange));
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnOrange), PointerButton::kRight);
  REQUIRE(app.settle());
  app.move({1, 1});
  app.frames(2);
  const std::string& whole = app.studio().messages().back().text;
  const std::string& shown = app.interface_state().message_text;
  CAPTURE(whole);
  CAPTURE(shown);
  REQUIRE(app.interface_state().message.size().x > 0);
  CHECK(whole.size() > 40);
  CHECK(shown.substr(0, 20) == whole.substr(0, 20));
  CHECK(shown.size() < whole.size());  // else this shows nothing
}

TEST_CASE("layout: names in Vietnamese, and accents that stand by themselves, have letters") {
  HeadlessApp app(640, 480);
  app.frames(1);
  const Theme& theme = app->interface().theme();
  for (const ImFont* font : {theme.body, theme.strong, theme.title})
    for (const int letter : {0x111, 0x1a1, 0x1b0, 0x301, 0x323, 0x1ea1, 0x1ed9, 0x1ef9, 0x416, 0x3a9}) {
      CAPTURE(letter);
      CHECK(font->FindGlyphNoFallback(static_cast<ImWchar>(letter)));
    }
}
