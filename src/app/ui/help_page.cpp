// The page of keys.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "app/console/version.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

void heading(UiContext& ui, const char* text) {
  ImGui::PushFont(ui.theme.strong);
  ImGui::TextColored(ui.theme.colour.accent, "%s", text);
  ImGui::PopFont();
}

// Keys of one heading; all keys of an action are on its first row.
void key_group(UiContext& ui, const char* group) {
  heading(ui, group);
  Action before = Action::kNone;
  for (const Binding& b : key_bindings()) {
    if (b.action == before || std::strcmp(b.group, group) != 0) continue;
    before = b.action;
    const float left = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(keys_of(b.action).c_str());
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + keys_width());
    ImGui::PushTextWrapPos(left + ImGui::GetColumnWidth() - 24);
    muted_text(ui, b.what);
    ImGui::PopTextWrapPos();
  }
  ImGui::Dummy({0, 6});
}

void pointer_help(UiContext& ui) {
  heading(ui, "Pointer");
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + ImGui::GetColumnWidth() - 24);
  muted_text(ui, pointer_words());
  ImGui::PopTextWrapPos();
}

// Of the window in which nothing else takes these keys.
void scroll_by_keys() {
  const float page = 0.9f * ImGui::GetWindowHeight(), line = 3 * ImGui::GetTextLineHeightWithSpacing(),
              all = ImGui::GetScrollMaxY();
  const std::pair<int, float> steps[] = {{key::kDown, line},    {key::kUp, -line}, {key::kPageDown, page},
                                         {key::kPageUp, -page}, {key::kEnd, all},  {key::kHome, -all}};
  for (const auto& [code, step] : steps)
    if (ImGui::IsKeyPressed(code)) ImGui::SetScrollY(std::clamp(ImGui::GetScrollY() + step, 0.0f, all));
}

}  // namespace

std::string pointer_words() {
  return std::string("Click: ") + Tool::kClick.sentence + " Navigate: " + Tool::kNavigate.sentence +
         " A middle drag turns with any tool, with Shift it shifts. Shift+wheel: sizes of the last click at "
         "any "
         "time; while a flight key is held, the wheel changes the speed. While other meanings of a click are "
         "shown, 1, 2 and 3 choose one, until Esc. Where one clicks, draws or selects, Shift adds, Ctrl "
         "removes, "
         "Alt intersects. Alt+wheel: the brush. Tab marks buttons and fields, Enter presses them.";
}

float keys_width() {
  constexpr float kColumnGap = 10;
  float width = 0;
  for (const Binding& b : key_bindings())
    width = std::max(width, ImGui::CalcTextSize(keys_of(b.action).c_str()).x);
  return width + kColumnGap;
}

void help_page(UiContext& ui) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  if (!begin_dialog("Keys and pointer###help", ui.state.help_open,
                    {std::min(1400.0f, screen.x - 40), std::min(720.0f, screen.y - 40)}))
    return;
  ImGui::BeginChild("keys", {0, -40});
  scroll_by_keys();
  const int columns = std::clamp(static_cast<int>(ImGui::GetContentRegionAvail().x / 310), 1, 4);
  ImGui::Columns(columns, "groups", false);
  for (const char* group : {"File", "Edit", "Selection"}) key_group(ui, group);
  if (columns > 1) ImGui::NextColumn();
  key_group(ui, "Tools");
  if (columns < 4) pointer_help(ui);
  if (columns > 2) ImGui::NextColumn();
  key_group(ui, "Display");
  if (columns == 4) ImGui::NextColumn();
  key_group(ui, "Camera");
  if (columns == 4) pointer_help(ui);
  ImGui::Columns(1);
  ImGui::EndChild();
  const bool closed =
      escape_pressed() || (ImGui::IsKeyPressed(key::kF1, false) && !ImGui::IsWindowAppearing());
  if (plain_button(ui, "Close", 110) || closed || enter_pressed()) {
    ui.state.help_open = false;
    ImGui::CloseCurrentPopup();
  }
  if (!ui.state.steady) {
    ImGui::SameLine();
    muted_text(ui, fmt::format("splatcut {}, MIT licence", version()));
  }
  ImGui::EndPopup();
}
}  // namespace splatcut
