// The bar along the top and the column of tools.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

constexpr float kGap = 16;  // between groups, points

// Of the buttons at the right end, points; in a small window half of them lie behind one.
constexpr float kDisplayWidth = 452, kShortWidth = 292;

float display_width() {
  constexpr float kRoomForAll = 800;
  return ImGui::GetWindowWidth() >= kRoomForAll ? kDisplayWidth : kShortWidth;
}

void gap() {
  ImGui::SameLine(0, kGap);
}

// Before the next of the tool's options. In a row of their own those that have no room begin another one.
void next_option(const UiContext& ui, float width) {
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (!ui.state.options_below || ImGui::GetItemRectMax().x + kGap + width <= end) ImGui::SameLine(0, kGap);
}

// Of buttons beside each other.
float width_of(std::initializer_list<const char*> labels) {
  constexpr float kBetween = 2;
  float width = -kBetween;
  for (const char* label : labels)
    width += ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x + kBetween;
  return width;
}

void set_view(UiContext& ui, const ViewState& view) {
  ui.ask(SetView{view});
}

// Of the next slider: less where the row is narrow.
void set_option_width() {
  constexpr float kUsual = 130, kNarrow = 100, kNarrowRow = 400;
  ImGui::SetNextItemWidth(ImGui::GetWindowWidth() < kNarrowRow ? kNarrow : kUsual);
}

void brush_size(UiContext& ui) {
  ViewState view = ui.studio.view();
  const float share = tool_of(view.tool).brush;
  ImGui::AlignTextToFramePadding();
  muted_text(ui, "Size");
  ImGui::SameLine();
  set_option_width();
  float shown = share * view.brush_px;
  if (numbered_slider(ui, "##brush", &shown, share * kLeastBrushPx, share * kMostBrushPx, "%.0f pt",
                      ImGuiSliderFlags_Logarithmic, "120 pt")) {
    view.brush_px = shown / share;
    set_view(ui, view);
  }
  tooltip(fmt::format("Brush radius  ({}, {}, Alt+wheel)", keys_of(Action::kBrushSmaller),
                      keys_of(Action::kBrushLarger)));
}

// Where the options end: at the display buttons, or in a row of their own.
float options_end(const UiContext& ui) {
  return ImGui::GetWindowWidth() - (ui.state.options_below ? 0 : display_width());
}

// Where there is room for it.
void tool_hint(UiContext& ui) {
  const std::string words =
      fmt::format(fmt::runtime(tool_of(ui.studio.view().tool).hint), ui.studio.tools().points_set());
  const char* text = words.c_str();
  ImGui::AlignTextToFramePadding();
  if (ImGui::GetCursorPosX() + ImGui::CalcTextSize(text).x <= options_end(ui)) muted_text(ui, text);
}

void tolerance(UiContext& ui) {
  ViewState view = ui.studio.view();
  ImGui::SetNextItemWidth(150);
  if (tolerance_slider(ui, &view.colour_tolerance)) set_view(ui, view);
  tooltip("How far a colour may differ, in any of red, green and blue");
}

constexpr float kDepthWidth = 180;  // of the depth limit with its number

void depth_limit(UiContext& ui) {
  ViewState view = ui.studio.view();
  const float size = ui.studio.camera().scene_size();
  float depth = view.depth_limit * size;
  const std::string text = depth > 0 ? length_format(depth) + " deep" : "no limit";
  ImGui::SetNextItemWidth(kDepthWidth);
  if (numbered_slider(ui, "##depth", &depth, 0, 0.5f * size, text.c_str(), kTypedLength, "0.00123 deep")) {
    view.depth_limit = depth / size;
    set_view(ui, view);
  }
  tooltip("How far behind the visible surface it reaches, in scene units; at the left end there is no limit");
}

void region_options(UiContext& ui) {
  ViewState view = ui.studio.view();
  struct Choice {
    SetOperation operation;
    const char *label, *sign, *tip;
  };
  constexpr Choice kChoices[] = {
      {SetOperation::kAdd, "Add", "+", "Add to the selection  (Shift)"},
      {SetOperation::kRemove, "Remove", "-", "Take out of the selection  (Ctrl)"},
      {SetOperation::kIntersect, "Intersect", "&", "Keep only what is in both  (Alt)"}};
  constexpr float kWordsWidth = 480;  // of the choices in words
  if (tool_of(view.tool).brush > 0) next_option(ui, width_of({"+", "-", "&"}));
  const float room = options_end(ui) - ImGui::GetCursorPosX();
  const bool narrow = room < kWordsWidth;
  for (const Choice& c : kChoices) {
    if (c.operation != SetOperation::kAdd) ImGui::SameLine(0, 2);
    if (button(ui, narrow ? c.sign : c.label, c.tip, {}, view.operation == c.operation)) {
      view.operation = c.operation;
      set_view(ui, view);
    }
  }
  if (tool_of(view.tool).selects == Tool::Selects::kColours) {
    gap();
    return tolerance(ui);
  }
  next_option(ui, width_of({"Centres"}));
  action_button(ui, Action::kByCentre, "Centres", view.by_centre);
  if (tool_of(view.tool).selects == Tool::Selects::kSpace) {
    gap();
    return tool_hint(ui);
  }
  const char *of_surface = narrow ? "Visible" : "Visible only", *of_all = narrow ? "Through" : "See-through";
  next_option(ui, width_of({of_surface, of_all}));
  const bool visible = button(ui, of_surface, "Takes the surface that you see  (V)", {}, !view.see_through);
  ImGui::SameLine(0, 2);
  const bool through =
      button(ui, of_all, "Takes what is hidden behind the surface, too  (V)", {}, view.see_through);
  if ((visible && view.see_through) || (through && !view.see_through)) ui.ask(Action::kSeeThrough);
  // The limit of depth comes and goes with the switch: where it has no room, in a row of its own.
  ui.state.depth_below = view.see_through && !ui.state.options_below &&
                         ImGui::GetItemRectMax().x + kGap + kDepthWidth > options_end(ui);
  if (!view.see_through || ui.state.depth_below) return;
  next_option(ui, kDepthWidth);
  depth_limit(ui);
}

// With signs in place of words; hints and the limit of depth go where there is no room for them.
float options_width(const UiContext& ui) {
  constexpr float kBrush = 205, kRegion = 310, kColour = 245, kSpace = 170;
  if (!ui.studio.scene()) return 0;
  const ViewState& view = ui.studio.view();
  const float brush = tool_of(view.tool).brush > 0 ? kBrush : 0;
  switch (tool_of(view.tool).selects) {
    case Tool::Selects::kNothing:
      return brush;
    case Tool::Selects::kSpace:
      return brush + kSpace;
    case Tool::Selects::kColours:
      return brush + kColour;
    default:
      return brush + kRegion;
  }
}

void tool_options(UiContext& ui) {
  const Tool& tool = tool_of(ui.studio.view().tool);
  if (tool.brush > 0) brush_size(ui);
  if (tool.selects != Tool::Selects::kNothing) return region_options(ui);
  if (tool.brush > 0) gap();
  if (*tool.hint) tool_hint(ui);
}

}  // namespace

void options_row(UiContext& ui) {
  if (!ui.state.depth_below) return tool_options(ui);
  ImGui::AlignTextToFramePadding();
  muted_text(ui, "See-through");
  ImGui::SameLine();
  depth_limit(ui);
}

namespace {

// radius in points.
void draw_icon(ImDrawList& list, const Icon& icon, const ImVec2& centre, float radius, ImU32 ink) {
  constexpr float kLine = 1.6f;
  const auto at = [&](const glm::vec2& p) {
    return ImVec2(centre.x + p.x * radius, centre.y + p.y * radius);
  };
  for (const IconMark& mark : icon) {
    switch (mark.kind) {
      case IconMark::Kind::kDot:
        list.AddCircleFilled(at(mark.points.front()), mark.radius * radius, ink);
        break;
      case IconMark::Kind::kRing:
        list.AddCircle(at(mark.points.front()), mark.radius * radius, ink, 0, kLine);
        break;
      case IconMark::Kind::kLine:
      case IconMark::Kind::kLoop:
        for (const glm::vec2& p : mark.points) list.PathLineTo(at(p));
        list.PathStroke(ink, mark.kind == IconMark::Kind::kLoop ? ImDrawFlags_Closed : 0, kLine + mark.wider);
        break;
    }
  }
}

void look_buttons(UiContext& ui) {
  const ViewState& view = ui.studio.view();
  action_button(ui, Action::kSideBySide, icon::kColumns,
                view.display == DisplayMode::kSideBySide || view.display == DisplayMode::kBeforeAfter);
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kCleanEdges, "Clean", view.clean_edges);
  gap();
  action_button(ui, Action::kTint, icon::kTint, view.tint);
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kOutline, icon::kOutline, view.outline);
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kHeat, icon::kHeat, view.heat);
}

void display_buttons(UiContext& ui) {
  const DisplayMode mode = ui.studio.view().display;
  action_button(ui, Action::kShowAll, "Whole",
                mode == DisplayMode::kWhole && ui.studio.view().hidden.empty());
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kIsolate, "Isolate", mode == DisplayMode::kIsolate);
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kHide, "Hide", mode == DisplayMode::kHide);
  ImGui::SameLine(0, 2);
  if (display_width() == kDisplayWidth) {
    look_buttons(ui);
  } else if (button(ui, fmt::format("{}##looks", icon::kDown).c_str(),
                    "Side by side, clean edges, tint, outline, heat")) {
    ImGui::OpenPopup("looks");
  }
  if (ImGui::BeginPopup("looks")) {
    look_buttons(ui);
    ImGui::EndPopup();
  }
  gap();
  action_button(ui, Action::kSettings, icon::kGear, ui.state.settings_open);
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kHelp, icon::kHelp, ui.state.help_open);
}

}  // namespace

void top_bar(UiContext& ui) {
  constexpr float kRoomForWords = 880;
  const bool words = ImGui::GetWindowWidth() >= kRoomForWords;
  const auto labelled = [&](Action action, const char* symbol, const char* word) {
    action_button(ui, action, words ? fmt::format("{} {}", symbol, word).c_str() : symbol);
  };
  labelled(Action::kOpen, icon::kOpen, "Open");
  ImGui::SameLine(0, 1);
  const std::string nothing =
      ui.state.recent.empty() && !ui.studio.scene() ? "Nothing was opened so far" : "";
  if (button(ui, icon::kDown, "Recent files; add a scene to this one", nothing)) ImGui::OpenPopup("recent");
  if (ImGui::BeginPopup("recent")) {
    const std::string add = fmt::format("{} Add a scene to this one", icon::kPlus);
    if (ui.studio.scene() && ImGui::Selectable(add.c_str())) ui.ask(Action::kAddScene);
    recent_list(ui);
    ImGui::EndPopup();
  }
  ImGui::SameLine(0, 2);
  labelled(Action::kSave, icon::kSave, "Save");
  ImGui::SameLine(0, 2);
  labelled(Action::kExport, icon::kExport, "Export");
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kSnapshot, icon::kCamera);
  ImGui::SameLine(0, 2);
  turntable_button(ui, icon::kFilm, 0);
  gap();
  action_button(ui, Action::kUndo, icon::kUndo);
  ImGui::SameLine(0, 2);
  action_button(ui, Action::kRedo, icon::kRedo);
  gap();
  ui.state.options_below =
      options_width(ui) > ImGui::GetWindowWidth() - display_width() - ImGui::GetCursorPosX();
  ui.state.depth_below = false;
  if (ui.studio.scene() && !ui.state.options_below) tool_options(ui);
  ImGui::SameLine(ImGui::GetWindowWidth() - display_width());
  display_buttons(ui);
}

void tool_column(UiContext& ui) {
  // Small windows have small buttons without gaps between groups, but every tool.
  constexpr float kLargest = 38, kSmallest = 22, kBetween = 3;
  const auto groups = static_cast<float>(std::ranges::count_if(tools(), &Tool::first_of_group));
  const float all = ImGui::GetContentRegionAvail().y;
  const auto room = [&](float separator) {
    return (all - groups * separator) / static_cast<float>(tools().size()) - kBetween;
  };
  const float wide = 3 + 3 * ImGui::GetStyle().ItemSpacing.y, tight = 1 + kBetween;
  const bool gaps = room(wide) >= kSmallest;
  const float side = std::floor(std::clamp(room(gaps ? wide : tight), kSmallest, kLargest));
  for (const Tool* tool : tools()) {
    if (tool->first_of_group) {
      if (!gaps) ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, kBetween});
      if (gaps) ImGui::Dummy({0, 1});
      ImGui::Separator();
      if (gaps) ImGui::Dummy({0, 1});
      if (!gaps) ImGui::PopStyleVar();
    }
    const Action action = action_of(*tool);
    const bool on = ui.studio.view().tool == *tool;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 0.5f * (kLargest - side));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(tool->name);
    if (!on) ImGui::PushStyleColor(ImGuiCol_Button, {0, 0, 0, 0});
    const std::string reason = ui.studio.why_not(action);
    const std::string keys = keys_of(action);
    const bool lent = !keys.empty() && ui.studio.clicks().chooses_by(keys.front());
    const std::string tip = fmt::format("{}\n{}{}", tip_of(action), tool->sentence,
                                        lent ? "\nIts key is for meanings of the click now, until Esc" : "");
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 3});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0);
    ImGui::BeginDisabled(!reason.empty());
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ui.theme.colour.accent);
    const bool pressed = ImGui::Button("##tool", {side, side});
    ImGui::PopStyleColor();
    ImGui::EndDisabled();
    ImGui::PopStyleVar(2);
    ImGui::PopID();
    if (pressed) ui.ask(action);
    tooltip(reason.empty() ? tip : tip + "\n" + reason);
    const ImVec4 ink = on ? ui.theme.colour.on_accent : ui.theme.colour.text;
    draw_icon(*ImGui::GetWindowDrawList(), tool->icon(), {corner.x + side / 2, corner.y + side / 2},
              std::min(10.5f, 0.3f * side), packed(ink, reason.empty() ? 1.0f : 0.4f));
  }
}

}  // namespace splatcut
