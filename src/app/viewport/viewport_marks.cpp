// What is drawn over the picture: points that were set, a sign at the pointer, the axes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/ui/widgets.h"
#include "app/viewport/on_screen.h"
#include "app/viewport/viewport_pane.h"

namespace splatcut {

namespace {

const ImU32 kMarkShade = IM_COL32(0, 0, 0, 150), kMarkWhite = IM_COL32(255, 255, 255, 235);

void boxed_text(ImDrawList& list, const ImVec2& middle, const std::string& text, const UiContext& ui) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 from = {middle.x - 0.5f * size.x, middle.y - 0.5f * size.y};
  list.AddRectFilled({from.x - 6, from.y - 3}, {from.x + size.x + 6, from.y + size.y + 3},
                     packed(ui.theme.colour.panel, 0.92f), 5);
  list.AddText(from, packed(ui.theme.colour.text), text.c_str());
}

struct Axis {
  const char* name;
  glm::vec3 direction_world;
  ImU32 ink;
  glm::vec3 seen;  // camera axes
};

// The six ends of the axes, the farthest first.
std::array<Axis, 6> axes_seen_by(const Camera& camera, const AxisSigns& of_file) {
  const auto [red, green, blue] = kAxisInks;
  std::array<Axis, 6> axes = {Axis{"X", {1, 0, 0}, red, {}},     Axis{"Y", {0, 1, 0}, green, {}},
                              Axis{"Z", {0, 0, 1}, blue, {}},    Axis{"-X", {-1, 0, 0}, red, {}},
                              Axis{"-Y", {0, -1, 0}, green, {}}, Axis{"-Z", {0, 0, -1}, blue, {}}};
  for (Axis& axis : axes) {
    axis.direction_world = of_file.position(axis.direction_world);
    axis.seen = camera.camera_from_world_rotation * axis.direction_world;
  }
  std::ranges::stable_sort(axes, [](const Axis& a, const Axis& b) { return a.seen.z > b.seen.z; });
  return axes;
}

const char* sign_of(const UiContext& ui) {
  const Tool& tool = tool_of(ui.studio.view().tool);
  const Modifiers& held = ui.studio.held();
  const ToolOverlay overlay = ui.studio.overlay();
  if (tool.shows_keys) return held.alt ? "x" : held.ctrl ? "-" : held.shift ? "+" : nullptr;
  if (tool.selects == Tool::Selects::kNothing) return nullptr;
  return overlay.operation == SetOperation::kRemove      ? "-"
         : overlay.operation == SetOperation::kIntersect ? "x"
                                                         : "+";
}

}  // namespace

void draw_points(const UiContext& ui, const UiRect& area) {
  const ToolOverlay overlay = ui.studio.overlay();
  if (overlay.shape != ToolOverlay::Shape::kPoints) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const OnScreen place = on_screen(ui, area);
  std::vector<ImVec2> at;
  for (const glm::vec2& p : overlay.points_px) at.push_back(place(p));
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    list.AddLine(at[i], at[i + 1], kMarkShade, 4);
    list.AddLine(at[i], at[i + 1], packed(ui.theme.colour.accent), 2);
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    list.AddCircleFilled(at[i], 6.5f, kMarkShade);
    list.AddCircleFilled(at[i], 5, packed(ui.theme.colour.accent));
    list.AddCircle(at[i], 5, kMarkWhite, 0, 1.3f);
    if (overlay.counted) boxed_text(list, {at[i].x + 18, at[i].y - 14}, fmt::format("{}", i + 1), ui);
  }
  if (overlay.length && at.size() == 2)
    boxed_text(list, {0.5f * (at[0].x + at[1].x), 0.5f * (at[0].y + at[1].y) - 18},
               length_text(*overlay.length) + " units", ui);
}

std::optional<ImVec2> pointed_at(const UiContext& ui, const UiRect& area) {
  if (const auto& cursor_px = ui.studio.cursor_px()) return on_screen(ui, area)(*cursor_px);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!area.contains({mouse.x, mouse.y}) || ImGui::IsAnyItemHovered() ||
      ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel))
    return {};
  return mouse;
}

// An arc that runs around: the outline of what lies under the pointer is still looked for.
void draw_looking(const UiContext& ui, const UiRect& area) {
  const std::optional<ImVec2> pointer = pointed_at(ui, area);
  if (!pointer || !ui.studio.clicks().looking()) return;
  constexpr float kRadius = 6, kArc = 4.2f, kTurnsPerSecond = 0.8f;
  const float from =
      ui.state.steady
          ? 0
          : 6.2831853f * static_cast<float>(std::fmod(kTurnsPerSecond * ui.studio.clock_s(), 1.0));
  const ImVec2 at = {pointer->x + 17, pointer->y + 15};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(at, kRadius + 3, kMarkShade);
  list.PathArcTo(at, kRadius, from, from + kArc);
  list.PathStroke(kMarkWhite, 0, 2);
  ui.state.items.push_back({"looking", {at.x - kRadius, at.y - kRadius}, {at.x + kRadius, at.y + kRadius}});
}

// A ring with four arms, whose middle is free: what lies there stays in sight. Filled while it draws.
void draw_key_cursor(const UiContext& ui, const UiRect& area) {
  if (!ui.studio.cursor_px()) return;
  constexpr float kRadius = 8, kArmEnd = 15;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 at = *pointed_at(ui, area);
  const bool draws = ui.studio.cursor_draws();
  for (const auto& [ink, wider] :
       {std::pair(kMarkShade, 2.5f), {draws ? packed(ui.theme.colour.accent) : kMarkWhite, 0.0f}}) {
    list.AddCircle(at, kRadius, ink, 0, 1.8f + wider);
    for (const glm::vec2& arm : {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
      list.AddLine({at.x + kRadius * arm.x, at.y + kRadius * arm.y},
                   {at.x + kArmEnd * arm.x, at.y + kArmEnd * arm.y}, ink, 1.8f + wider);
    if (draws) list.AddCircleFilled(at, 2.5f + 0.5f * wider, ink);
  }
}

void draw_cursor_sign(const UiContext& ui, const UiRect& area) {
  const char* sign = sign_of(ui);
  const std::optional<ImVec2> pointer = pointed_at(ui, area);
  if (!sign || !pointer) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr float kArm = 4.5f;
  const ImVec2 at = {pointer->x + 17, pointer->y + 15};
  const ImU32 ink = *sign == '+'   ? IM_COL32(90, 220, 120, 255)
                    : *sign == '-' ? IM_COL32(245, 95, 90, 255)
                                   : packed(ui.theme.colour.accent);
  list.AddCircleFilled(at, 9, kMarkShade);
  if (*sign == 'x') {  // two rings that meet: what is in both
    list.AddCircle({at.x - 2.2f, at.y}, 3.8f, ink, 0, 1.6f);
    list.AddCircle({at.x + 2.2f, at.y}, 3.8f, ink, 0, 1.6f);
    return;
  }
  list.AddLine({at.x - kArm, at.y}, {at.x + kArm, at.y}, ink, 2);
  if (*sign == '+') list.AddLine({at.x, at.y - kArm}, {at.x, at.y + kArm}, ink, 2);
}

UiRect axes_gizmo(UiContext& ui, const UiRect& area) {
  constexpr float kRadius = 34, kMargin = 12, kBall = 9;
  static_assert(kAxesWidth == kMargin + 2 * (kRadius + kBall));
  const ImVec2 middle = {area.max.x - kMargin - kRadius - kBall, area.min.y + kMargin + kRadius + kBall};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Camera camera = ui.studio.viewport().pane_camera();
  for (const Axis& axis : axes_seen_by(camera, axes_of_file(ui.studio))) {
    const ImVec2 at = {middle.x + kRadius * axis.seen.x, middle.y + kRadius * axis.seen.y};
    const bool positive = axis.name[0] != '-';
    bool hovered = false;
    if (!ui.studio.tools().at_work()) {  // else a click is a corner of what is drawn
      ImGui::SetCursorScreenPos({at.x - kBall, at.y - kBall});
      ImGui::PushID(axis.name);
      ImGui::SetItemAllowOverlap();
      // Looks from that end at the middle.
      if (ImGui::InvisibleButton("axis", {2 * kBall, 2 * kBall})) ui.ask(LookAlong{-axis.direction_world});
      hovered = ImGui::IsItemHovered();
      tooltip(fmt::format("Look from {}", axis.name));
      ImGui::PopID();
    }
    if (positive) list.AddLine(middle, at, axis.ink, 2);
    const float size = positive ? kBall : 0.6f * kBall;
    list.AddCircleFilled(at, size, positive || hovered ? axis.ink : packed(ui.theme.colour.panel, 0.8f));
    list.AddCircle(at, size, hovered ? kMarkWhite : axis.ink, 0, 1.5f);
    if (!positive) continue;
    const ImVec2 text = ImGui::CalcTextSize(axis.name);
    list.AddText({at.x - 0.5f * text.x, at.y - 0.5f * text.y}, IM_COL32(15, 15, 18, 255), axis.name);
  }
  const float reach = kRadius + kBall;
  return {{middle.x - reach, middle.y - reach}, {middle.x + reach, middle.y + reach}};
}

}  // namespace splatcut
