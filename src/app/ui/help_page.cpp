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

// Whether the next row, that high, is within the page: one that would be cut leaves its room empty.
bool shows_whole(float height) {
  const float from = ImGui::GetCursorScreenPos().y - ImGui::GetWindowPos().y;
  constexpr float kRounding = 0.5f;
  if (from >= -kRounding && from + height <= ImGui::GetWindowHeight() + kRounding) return true;
  ImGui::Dummy({1, height});
  return false;
}

void note_row(UiContext& ui, const ImVec2& from) {
  ui.state.items.push_back(
      {"row of keys", {from.x, from.y}, {ImGui::GetItemRectMax().x, ImGui::GetItemRectMax().y}});
}

void heading(UiContext& ui, const char* text) {
  if (!shows_whole(ui.theme.strong->FontSize * ImGui::GetIO().FontGlobalScale)) return;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::PushFont(ui.theme.strong);
  ImGui::TextColored(ui.theme.colour.accent, "%s", text);
  ImGui::PopFont();
  note_row(ui, from);
}

// Keys of one heading; all keys of an action are on its first row.
void key_group(UiContext& ui, const char* group) {
  heading(ui, group);
  Action before = Action::kNone;
  for (const Binding& b : key_bindings()) {
    if (b.action == before || std::strcmp(b.group, group) != 0) continue;
    before = b.action;
    const float left = ImGui::GetCursorPosX();
    const float room = ImGui::GetColumnWidth() - 24 - keys_width();
    if (!shows_whole(ImGui::CalcTextSize(b.what, nullptr, false, std::max(1.0f, room)).y)) continue;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    ImGui::TextUnformatted(keys_of(b.action).c_str());
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + keys_width());
    ImGui::PushTextWrapPos(left + ImGui::GetColumnWidth() - 24);
    muted_text(ui, b.what);
    ImGui::PopTextWrapPos();
    note_row(ui, from);
  }
  ImGui::Dummy({0, 6});
}

void pointer_help(UiContext& ui) {
  heading(ui, "Pointer");
  const std::string words = pointer_words();
  const float room = std::max(1.0f, ImGui::GetColumnWidth() - 24);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 0});
  for (const char *at = words.data(), *end = at + words.size(); at < end;) {
    const char* line = ImGui::GetFont()->CalcWordWrapPositionA(ImGui::GetIO().FontGlobalScale, at, end, room);
    if (line == at) ++line;  // no room for a letter
    if (shows_whole(ImGui::GetTextLineHeight())) {
      const ImVec2 from = ImGui::GetCursorScreenPos();
      muted_text(ui, std::string(at, line));
      note_row(ui, from);
    }
    for (at = line; at < end && *at == ' ';) ++at;
  }
  ImGui::PopStyleVar();
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
         "any time; while a flight key is held, the wheel changes the speed. While other meanings of a click "
         "are shown, 1, 2 and 3 choose one, until Esc; after a click without, they are tools, and say so. "
         "Where one clicks, draws or selects, Shift adds, Ctrl removes, Alt intersects. Alt+wheel: the "
         "brush. Tab marks buttons and fields, Enter presses them.";
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
