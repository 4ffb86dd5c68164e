// The views that the cut used, each with its mask, and some around the object: click to look from there, or
// leave out what it used.
#include <algorithm>

#include "app/picture/cut_sentences.h"
#include "app/ui/widgets.h"
#include "app/viewport/viewport_pane.h"

namespace splatcut {

namespace {

constexpr float kCardGap = 6, kAroundCards = 20;
constexpr std::uint64_t kCardKey = 1000;  // of the strip's textures

// Smaller ones leave most of a small picture free.
float card_height(const Studio& studio) {
  constexpr float kUsual = 76, kSmall = 44, kSmallPicture = 420;
  const Viewport& viewport = studio.viewport();
  return viewport.size_px().y < kSmallPicture * viewport.pixels_per_point() ? kSmall : kUsual;
}

float card_width(const ViewCard& c, float height) {
  return height * static_cast<float>(c.picture->width()) / static_cast<float>(c.picture->height());
}

void card(UiContext& ui, const ObjectItem& object, const ViewCard& c, std::size_t index) {
  const float height = card_height(ui.studio), width = card_width(c, height);
  ImGui::PushID(static_cast<int>(index));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("card", {width, height})) ui.ask(GoToCamera{c.camera});
  ImGui::SetItemAllowOverlap();
  const bool hovered = ImGui::IsItemHovered();
  tooltip(tip_of_card(c, index, ui.state.steady));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end = {at.x + width, at.y + height};
  list.AddImageRounded(ui.renderer.texture(kCardKey + index, c.serial, *c.picture), at, end, {0, 0}, {1, 1},
                       c.used || c.only_to_look ? 0xffffffffu : 0x70ffffffu, 4);
  list.AddRect(at, end, packed(hovered ? ui.theme.colour.accent : ui.theme.colour.line), 4, 0,
               hovered ? 2.0f : 1.0f);
  if (!c.doubt.empty()) {
    const ImVec2 middle = {at.x + 12, at.y + 12};
    const ImVec2 size = ImGui::CalcTextSize("?");
    list.AddCircleFilled(middle, 9, packed(ui.theme.colour.warn));
    list.AddText({middle.x - 0.5f * size.x, middle.y - 0.5f * size.y}, 0xff000000u, "?");
  }
  const bool left_out =
      std::ranges::any_of(object.left_out, [&](const Camera& v) { return same_view(v, c.camera); });
  constexpr float kLabelWidth = 72;
  if (index == 0 && width > kLabelWidth) {
    list.AddRectFilled({at.x + 4, end.y - 21}, {at.x + 68, end.y - 4}, packed({0, 0, 0, 1}, 0.6f), 3);
    list.AddText({at.x + 8, end.y - 21}, 0xffffffffu, "first view");
  } else if (index > 0 && !c.only_to_look && (hovered || left_out)) {
    ImGui::SetCursorScreenPos({end.x - 24, at.y + 3});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {3, 1});
    if (button(ui, left_out ? icon::kCheck : icon::kClose,
               left_out ? "Use this view again" : "Leave this view out of the cut",
               object.locked ? object.name + " is locked" : ""))
      ui.ask(LeaveOutView{object.id, c.camera, !left_out});
    ImGui::PopStyleVar();
    ImGui::SetCursorScreenPos(at);
    ImGui::Dummy({width, height});
  }
  ImGui::PopID();
}

}  // namespace

float view_strip_width(const Studio& studio) {
  const ObjectItem* object = studio.document().active_object();
  const CutRun* run = object ? studio.cuts().run(object->id) : nullptr;
  float width = 0;
  if (run && studio.scene())
    for (const ViewCard& c : run->views)
      if (c.picture) width += card_width(c, card_height(studio)) + (width > 0 ? kCardGap : 0);
  return width;
}

float view_strip_height(const Studio& studio) {
  return card_height(studio) + kAroundCards;
}

void view_strip(UiContext& ui) {
  const ObjectItem* object = ui.studio.document().active_object();
  const CutRun* run = object ? ui.studio.cuts().run(object->id) : nullptr;
  if (!run) return;
  for (std::size_t i = 0; i < run->views.size(); ++i) {
    if (!run->views[i].picture) continue;
    if (i > 0) ImGui::SameLine(0, kCardGap);
    card(ui, *object, run->views[i], i);
  }
}

}  // namespace splatcut
