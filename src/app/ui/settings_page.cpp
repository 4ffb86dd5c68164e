// What is set for the program, whatever scene is open. The window keeps it between starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

void row(const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  ImGui::SameLine(126);
  ImGui::SetNextItemWidth(-1);
}

// A size is refused in which the window would hold less than this page.
void size_buttons(UiContext& ui) {
  constexpr float kLeastWidth = 640, kLeastHeight = 480;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  float& scale = ui.state.ui_scale;
  const float before = scale;
  for (const int percent : {75, 100, 125, 150, 200}) {
    const float wanted = static_cast<float>(percent) / 100, shrunk = before / wanted;
    const bool fits =
        wanted <= before || std::min(window.x / kLeastWidth, window.y / kLeastHeight) * shrunk >= 1;
    if (percent != 75) ImGui::SameLine(0, 2);
    if (button(ui, fmt::format("{} %", percent).c_str(), "Size of texts, buttons and panels",
               fits ? "" : "The window is too small for that", std::abs(before - wanted) < 0.005f))
      scale = wanted;
  }
}

void view_rows(UiContext& ui) {
  ViewState view = ui.studio.view();
  row("Flying speed");
  constexpr auto kProportional = ImGuiSliderFlags_Logarithmic | kTypedLength;
  constexpr const char* kWidest = "1.25 x usual speed";
  bool set = numbered_slider(ui, "##speed", &view.fly_speed, kLeastKeptSpeed, kMostKeptSpeed,
                             "%.2g x usual speed", kProportional, kWidest);
  tooltip("Of the keys W, A, S, D, Q and E; the wheel changes it while one is held");
  row("Brush radius");
  set |= numbered_slider(ui, "##radius", &view.brush_px, kLeastBrushPx, kMostBrushPx, "%.0f pt",
                         kProportional, kWidest);
  tooltip(fmt::format("{}, {} and Alt+wheel change it, too", keys_of(Action::kBrushSmaller),
                      keys_of(Action::kBrushLarger)));
  row("Objects");
  set |= ImGui::Checkbox("Tint", &view.tint);
  tooltip(tip_of(Action::kTint));
  ImGui::SameLine(0, 18);
  set |= ImGui::Checkbox("Outline", &view.outline);
  tooltip(tip_of(Action::kOutline));
  row("Thin splats");
  set |= ImGui::Checkbox("As in web viewers", &view.web_low_pass);
  tooltip("They are drawn half as wide as in training; the cut does not change");
  if (set) ui.ask(SetView{view});
}

void set_as_at_first(UiContext& ui) {
  ViewState view = ui.studio.view();
  set_what_is_kept({}, &view);
  ui.ask(SetView{view});
  ui.state.dark = UiState().dark;
  ui.state.ui_scale = UiState().ui_scale;
}

}  // namespace

void settings_page(UiContext& ui) {
  if (!begin_dialog("Settings###settings", ui.state.settings_open, {470, 330})) return;
  const bool typing = typing_beside("");
  row("Theme");
  if (button(ui, "Dark", tip_of(Action::kTheme), {}, ui.state.dark)) ui.state.dark = true;
  ImGui::SameLine(0, 2);
  if (button(ui, "Light", tip_of(Action::kTheme), {}, !ui.state.dark)) ui.state.dark = false;
  row("Interface size");
  size_buttons(ui);
  view_rows(ui);
  row("Recent files");
  if (button(ui, "Forget them", "The list beside Open and on the start page; the files stay",
             ui.state.recent.empty() ? "There are none" : ""))
    ui.state.recent.clear();
  ImGui::SetCursorPosY(ImGui::GetWindowHeight() - 42);
  if (button(ui, "Reset all", "Everything above but the recent files")) set_as_at_first(ui);
  ImGui::SameLine(ImGui::GetWindowWidth() - 122);
  if (plain_button(ui, "Close", 110) || (!typing && (escape_pressed() || enter_pressed()))) {
    ui.state.settings_open = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace splatcut
