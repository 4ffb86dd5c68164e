#include "app/ui/widgets.h"

#include <fmt/format.h>
#include <imgui_internal.h>  // GetActiveID, FindRenderedTextEnd

#include <algorithm>
#include <cmath>
#include <utility>

namespace splatcut {

std::string tip_of(Action action) {
  const std::string keys = keys_of(action);
  return keys.empty() ? name_of(action) : fmt::format("{}  ({})", name_of(action), keys);
}

ImVec4 colour_of(const Rgb8& c) {
  return {static_cast<float>(c[0]) / 255, static_cast<float>(c[1]) / 255, static_cast<float>(c[2]) / 255, 1};
}

namespace {

// Whether ImGui shows a dialog other than that one. Menus, lists and pickers are none: they close when a
// dialog opens.
bool another_dialog(const char* id) {
  const ImVector<ImGuiPopupData>& open = GImGui->OpenPopupStack;
  return !open.empty() && open[0].PopupId != ImGui::GetID(id) && open[0].Window &&
         (open[0].Window->Flags & ImGuiWindowFlags_Modal) != 0;
}

// Keys of a dialog's storage.
const ImGuiID kPointerRests = ImHashStr("pointer rests"), kRestsAtX = ImHashStr("rests at x"),
              kRestsAtY = ImHashStr("rests at y");

// Notes whether the pointer has moved since the dialog appeared.
void see_whether_pointer_rests() {
  ImGuiStorage& kept = ImGui::GetCurrentWindow()->StateStorage;
  const ImVec2 pointer = ImGui::GetMousePos();
  if (ImGui::IsWindowAppearing()) {
    kept.SetBool(kPointerRests, true);
    kept.SetFloat(kRestsAtX, pointer.x);
    kept.SetFloat(kRestsAtY, pointer.y);
  } else if (pointer.x != kept.GetFloat(kRestsAtX) || pointer.y != kept.GetFloat(kRestsAtY)) {
    kept.SetBool(kPointerRests, false);
  }
}

// Whether a dialog came below a pointer that did not move since: nobody points at what lies there.
bool pointer_rests() {
  return ImGui::GetCurrentWindow()->RootWindow->StateStorage.GetBool(kPointerRests) &&
         !GImGui->NavDisableMouseHover;  // the keyboard moves on alone
}

}  // namespace

bool begin_dialog(const char* id, bool wanted, const ImVec2& size, Turn turn) {
  const bool its_turn = turn == Turn::kFirst || !another_dialog(id);
  if (wanted && its_turn && !ImGui::IsPopupOpen(id)) ImGui::OpenPopup(id);
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(size.x, screen.x), std::min(size.y, screen.y)});
  if (!ImGui::BeginPopupModal(id, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) return false;
  see_whether_pointer_rests();
  return true;
}

bool enter_pressed() {
  const bool pressed =
      ImGui::IsKeyPressed(key::kEnter, false) || ImGui::IsKeyPressed(key::kKeypadEnter, false);
  return pressed && !ImGui::IsWindowAppearing();
}

bool escape_pressed() {
  return ImGui::IsKeyPressed(key::kEscape, false) && !ImGui::IsWindowAppearing();
}

bool typing_beside(const char* label) {
  const ImGuiID typed = ImGui::GetIO().WantTextInput ? ImGui::GetActiveID() : 0;
  return typed != 0 && typed != ImGui::GetID(label);
}

bool slider_without_text(const char* id, float* value, float least, float most, const char* format,
                         ImGuiSliderFlags flags) {
  const bool typed = ImGui::TempInputIsActive(ImGui::GetID(id));
  if (!typed) ImGui::PushStyleColor(ImGuiCol_Text, {0, 0, 0, 0});
  const bool changed = ImGui::SliderFloat(id, value, least, most, format, flags);
  if (!typed) ImGui::PopStyleColor();
  return changed;
}

bool numbered_slider(UiContext& ui, const char* id, float* value, float least, float most, const char* format,
                     ImGuiSliderFlags flags, const char* widest) {
  constexpr float kNumberGap = 8;
  const float room = ImGui::CalcTextSize(widest).x, width = ImGui::CalcItemWidth();
  ImGui::BeginGroup();  // one item, with one tooltip
  ImGui::SetNextItemWidth(width - room - kNumberGap);
  const bool changed = slider_without_text(id, value, least, most, format, flags);
  char number[64];
  ImFormatString(number, sizeof(number), format, *value);
  ImGui::SameLine(0, kNumberGap);
  muted_text(ui, number);
  ImGui::SameLine(0, std::max(0.0f, room - ImGui::CalcTextSize(number).x));
  ImGui::Dummy({0, 0});
  ImGui::EndGroup();
  return changed;
}

bool tolerance_slider(UiContext& ui, float* share) {
  float percent = 100 * *share;
  const bool changed =
      numbered_slider(ui, "##tolerance", &percent, 1, 50, "within %.0f %%", kTypedLength, "within 50 %");
  if (changed) *share = percent / 100;
  return changed;
}

namespace {

const ImGuiID kBesideWindow = ImHashStr("tooltips beside");  // key of a window's storage

// Where a tooltip of that size covers nothing that one moves on to: beside a column or a menu, under or over
// a row.
ImVec2 tooltip_place(const ImVec2& size, const UiRect& message) {
  constexpr float kTooltipGap = 6;
  const ImGuiWindow& window = *ImGui::GetCurrentWindow()->RootWindow;
  const ImVec2 screen = ImGui::GetIO().DisplaySize, from = ImGui::GetItemRectMin(),
               to = ImGui::GetItemRectMax();
  const ImRect around = window.Rect();
  const bool menu =
      (window.Flags & ImGuiWindowFlags_Popup) != 0 && (window.Flags & ImGuiWindowFlags_Modal) == 0;
  const bool rows = around.GetHeight() > 2 * ImGui::GetFrameHeightWithSpacing();
  ImVec2 at;
  if (ImGuiWindow& own = *ImGui::GetCurrentWindow(); own.StateStorage.GetBool(kBesideWindow)) {
    at = {own.Rect().Max.x + kTooltipGap, from.y};
    if (at.x + size.x > screen.x) at = own.Pos;  // over its heading
  } else if (rows && (menu || around.GetHeight() > around.GetWidth())) {
    const bool to_the_left = around.GetCenter().x > screen.x / 2;
    at = {to_the_left ? around.Min.x - kTooltipGap - size.x : around.Max.x + kTooltipGap, from.y};
  } else {
    at = {from.x, to.y + kTooltipGap};
    if (at.y + size.y > screen.y - kStatusHeight) at.y = from.y - kTooltipGap - size.y;
  }
  if (ImRect(at, {at.x + size.x, at.y + size.y})
          .Overlaps({message.min.x, message.min.y, message.max.x, message.max.y}))
    at.y = message.min.y - kTooltipGap - size.y;
  return {std::clamp(at.x, 0.0f, std::max(0.0f, screen.x - size.x)),
          std::clamp(at.y, 0.0f, std::max(0.0f, screen.y - kStatusHeight - size.y))};
}

}  // namespace

void tooltips_beside_window() {
  ImGui::GetCurrentWindow()->StateStorage.SetBool(kBesideWindow, true);
}

void tooltip(const std::string& text, const UiRect& message, const TipPicture& picture) {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || pointer_rests()) return;
  constexpr float kWidest = 320;
  const ImVec2 padding = ImGui::GetStyle().WindowPadding,
               words = ImGui::CalcTextSize(text.c_str(), nullptr, false, kWidest - padding.x);
  const float above = picture.size.y > 0 ? picture.size.y + ImGui::GetStyle().ItemSpacing.y : 0;
  ImGui::SetNextWindowPos(tooltip_place(
      {std::max(words.x, picture.size.x) + 2 * padding.x, words.y + above + 2 * padding.y}, message));
  ImGui::BeginTooltip();
  if (above > 0) ImGui::Image(picture.texture, picture.size);
  ImGui::PushTextWrapPos(kWidest);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void tooltip_within(const UiRect& area, const std::string& text) {
  constexpr float kBesidePointer = 14;
  const ImVec2 padding = ImGui::GetStyle().WindowPadding, words = ImGui::CalcTextSize(text.c_str()),
               pointer = ImGui::GetMousePos();
  const glm::vec2 size(words.x + 2 * padding.x, words.y + 2 * padding.y);
  const glm::vec2 at =
      glm::max(area.min, glm::min(glm::vec2(pointer.x, pointer.y) + kBesidePointer, area.max - size));
  ImGui::SetNextWindowPos({at.x, at.y});
  ImGui::SetTooltip("%s", text.c_str());
}

AxisSigns axes_of_file(const Studio& studio) {
  const OpenedScene* opened = studio.scene();
  const bool ours = !opened || opened->files.front().spz_axes == SpzAxes::kPly;
  return ours ? AxisSigns() : opened->scene->format.axes;
}

void progress_bar(UiContext& ui, double fraction, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, at.y + 9}, {at.x + width, at.y + 15}, packed(ui.theme.colour.line), 3);
  list.AddRectFilled({at.x, at.y + 9}, {at.x + width * static_cast<float>(fraction), at.y + 15},
                     packed(ui.theme.colour.accent), 3);
  ImGui::Dummy({width, 1});
}

void come_nearer_button(UiContext& ui, float width) {
  if (button(ui, "Come nearer", "Goes to where you clicked: a click there adds to this object", {}, true,
             width))
    ui.ask(ComeNearer{});
}

bool plain_button(UiContext& ui, const char* label, float width) {
  const bool pressed = ImGui::Button(label, {width, 0});
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  const std::string_view shown(label, ImGui::FindRenderedTextEnd(label));
  ui.state.items.push_back({std::string(shown), {min.x, min.y}, {max.x, max.y}});
  return pressed;
}

bool button(UiContext& ui, const char* label, const std::string& tip, const std::string& reason, bool on,
            float width) {
  const Palette& p = ui.theme.colour;
  if (on) {
    ImGui::PushStyleColor(ImGuiCol_Button, p.accent);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, p.accent);
    ImGui::PushStyleColor(ImGuiCol_Text, p.on_accent);
  }
  ImGui::BeginDisabled(!reason.empty());
  const bool pressed = plain_button(ui, label, width);
  ImGui::EndDisabled();
  if (on) ImGui::PopStyleColor(3);
  tooltip(reason.empty() ? tip : tip.empty() ? reason : tip + "\n" + reason);
  return pressed && reason.empty();
}

std::string tip_of(const Studio& studio, Action action) {
  std::string tip = tip_of(action);
  const ObjectItem* object = studio.document().active_object();
  const bool acts = action == Action::kIsolate || action == Action::kHide || action == Action::kFrameObject;
  const std::string_view the_object = "the object";
  if (const std::size_t at = tip.find(the_object); object && acts && at != std::string::npos)
    tip.replace(at, the_object.size(), object->name);
  return tip;
}

void action_button(UiContext& ui, Action action, const char* label, bool on, float width) {
  ImGui::PushID(static_cast<int>(action));
  if (button(ui, label, tip_of(ui.studio, action), ui.studio.why_not(action), on, width)) ui.ask(action);
  ImGui::PopID();
}

void clean_edges_choice(UiContext& ui, const std::string& reason) {
  ViewState view = ui.studio.view();
  bool shown = view.clean_edges && reason.empty();  // what is done: the setting itself stays
  ImGui::BeginDisabled(!reason.empty());
  if (ImGui::Checkbox("Clean edges", &shown) && reason.empty()) {
    view.clean_edges = shown;
    ui.ask(SetView{view});
  }
  ImGui::EndDisabled();
  tooltip(reason.empty()
              ? "Leaves out and trims what only shows, as ragged bits, once the object stands alone; "
                "else all is written as it is"
              : reason);
  if (reason.empty()) return;
  ImGui::SameLine();
  muted_text(ui, reason);
}

void fill_hole_choice(UiContext& ui) {
  ViewState view = ui.studio.view();
  if (ImGui::Checkbox("Fill the hole", &view.fill_hole)) ui.ask(SetView{view});
  tooltip(
      fmt::format("Continues a flat surface where the object stood, by copies of it. What is copied is "
                  "invented. {} shows it",
                  keys_of(Action::kFillHole)));
}

std::string sides_in_doubt(const Studio& studio, ExportWhat what) {
  if (what == ExportWhat::kScene) return {};
  const bool all = what == ExportWhat::kAllObjects || what == ExportWhat::kOneFile;
  const Document& document = studio.document();
  std::size_t sides = 0;
  for (const ObjectItem& item : document.objects)
    if (const CutRun* run = all || item.id == document.active ? studio.cuts().run(item.id) : nullptr)
      sides += static_cast<std::size_t>(
          std::ranges::count_if(run->views, [](const ViewCard& card) { return !card.doubt.empty(); }));
  if (sides == 0) return {};
  return fmt::format("{} in doubt: see the thumbnails with a question mark.",
                     sides == 1 ? "One side is" : fmt::format("{} sides are", sides));
}

void remember_finish(UiContext& ui) {
  if (!ui.state.view_before) ui.state.view_before = ui.studio.view();
}

void leave_finish(UiContext& ui, bool kept) {
  ViewState view = ui.studio.view();
  const ViewState before = std::exchange(ui.state.view_before, {}).value_or(view);
  if (kept) return;
  view.clean_edges = before.clean_edges;
  view.fill_hole = before.fill_hole;
  if (view != ui.studio.view()) ui.ask(SetView{view});
}

void muted_text(UiContext& ui, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.colour.muted);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

ButtonRow::ButtonRow(std::initializer_list<const char*> labels) {
  constexpr float kSpacing = 4;
  const float all = ImGui::GetContentRegionAvail().x, count = static_cast<float>(labels.size());
  width_ = (all - kSpacing * (count - 1)) / count;
  const float padding = ImGui::GetStyle().FramePadding.x;
  beside_ = std::ranges::all_of(labels, [&](const char* label) {
    return ImGui::CalcTextSize(label, nullptr, true).x + padding <= width_;
  });
  if (!beside_) width_ = all;
}

float ButtonRow::next() {
  if (std::exchange(begun_, true) && beside_) ImGui::SameLine(0, 4);
  return width_;
}

void same_line_if_fits(const char* label, float spacing) {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x,
              width = ImGui::CalcTextSize(label, nullptr, true).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (ImGui::GetItemRectMax().x + spacing + width <= right) ImGui::SameLine(0, spacing);
}

void wrapped_muted(UiContext& ui, const std::string& text) {
  ImGui::PushTextWrapPos(0);
  muted_text(ui, text);
  ImGui::PopTextWrapPos();
}

void wrapped_warning(UiContext& ui, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.colour.warn);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

bool section(UiContext& ui, const char* title, bool open) {
  ImGui::PushFont(ui.theme.strong);
  ImGui::PushStyleColor(ImGuiCol_Header, {0, 0, 0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2, 5});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0);
  const bool is_open = ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  return is_open;
}

}  // namespace splatcut
