// The views that the cut used, each with its mask, and some around the object: click to look from there, or
// leave out what it used.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/picture/cut_sentences.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

constexpr float kCardGap = 6;
constexpr std::uint64_t kCardKey = 1000, kLargeKey = kCardKey - 1;  // of the cards' textures

const CutRun* run_with_cards(const Studio& studio) {
  const ObjectItem* object = studio.document().active_object();
  const CutRun* run = object && studio.scene() ? studio.cuts().run(object->id) : nullptr;
  return run && std::ranges::any_of(run->views, [](const ViewCard& c) { return c.picture != nullptr; })
             ? run
             : nullptr;
}

struct CardGrid {
  int columns = 0, rows = 0;
  ImVec2 cell;  // points
  float height() const { return static_cast<float>(rows) * (cell.y + kCardGap) - kCardGap; }
};

// Smaller cards before one has to scroll.
CardGrid grid_of(const CutRun& run, const ImVec2& room) {
  constexpr int kUsual = 3, kMost = 5;  // columns
  int cards = 0;
  float steepest = 0;
  for (const ViewCard& c : run.views)
    if (c.picture) {
      ++cards;
      steepest = std::max(steepest,
                          static_cast<float>(c.picture->height()) / static_cast<float>(c.picture->width()));
    }
  CardGrid grid;
  for (grid.columns = kUsual;; ++grid.columns) {
    grid.rows = (cards + grid.columns - 1) / grid.columns;
    grid.cell.x = std::floor((room.x + kCardGap) / static_cast<float>(grid.columns) - kCardGap);
    grid.cell.y = std::floor(std::min(1.0f, steepest) * grid.cell.x);
    if (grid.columns == kMost || grid.height() <= room.y) return grid;
  }
}

// The whole picture within the cell.
ImVec2 card_size(const ViewCard& c, const ImVec2& cell) {
  const ImVec2 picture(static_cast<float>(c.picture->width()), static_cast<float>(c.picture->height()));
  const float scale = std::min(cell.x / picture.x, cell.y / picture.y);
  return {std::round(scale * picture.x), std::round(scale * picture.y)};
}

// What the thumbnail shows, larger, as small ones hide small bites; sharp once it is drawn.
TipPicture larger(UiContext& ui, const CutRun& run, const ViewCard& c) {
  constexpr float kWidth = 300, kMostHeight = 0.4f;  // points; share of the window
  if (!c.large && run.views_drawn) ui.ask(DrawLarger{c.serial});
  const ImTextureID texture =
      ui.renderer.texture(kLargeKey, 2 * c.serial + (c.large ? 1 : 0), c.large ? *c.large : *c.picture);
  return {texture, card_size(c, {kWidth, kMostHeight * ImGui::GetIO().DisplaySize.y})};
}

void card(UiContext& ui, const CutRun& run, const ObjectItem& object, const ViewCard& c, std::size_t index,
          const ImVec2& size) {
  const auto [width, height] = size;
  ImGui::PushID(static_cast<int>(index));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const glm::vec2 pointer(ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y);
  if (ImGui::InvisibleButton("card", {width, height})) {
    ui.ask(GoToCamera{c.camera});
    ui.state.looked_from_card_at = pointer;
  }
  ImGui::SetItemAllowOverlap();
  const bool hovered = ImGui::IsItemHovered();
  ui.state.items.push_back({fmt::format("side {}", index), {at.x, at.y}, {at.x + width, at.y + height}});
  if (ui.state.looked_from_card_at != pointer) {
    ui.state.looked_from_card_at.reset();
    tooltip(tip_of_card(c, index, ui.state.steady), ui.state.message,
            hovered ? larger(ui, run, c) : TipPicture());
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end = {at.x + width, at.y + height};
  list.AddImageRounded(ui.renderer.texture(kCardKey + index, c.serial, *c.picture), at, end, {0, 0}, {1, 1},
                       c.used || c.only_to_look ? 0xffffffffu : 0x70ffffffu, 4);
  list.AddRect(at, end, packed(hovered ? ui.theme.colour.accent : ui.theme.colour.line), 4, 0,
               hovered ? 2.0f : 1.0f);
  if (!c.doubt.empty()) {
    const ImVec2 middle = {at.x + 12, at.y + 12};
    const ImVec2 mark = ImGui::CalcTextSize("?");
    list.AddCircleFilled(middle, 9, packed(ui.theme.colour.warn));
    list.AddText({middle.x - 0.5f * mark.x, middle.y - 0.5f * mark.y}, ink_on(ui.theme.colour.warn), "?");
  }
  const bool left_out =
      std::ranges::any_of(object.left_out, [&](const Camera& v) { return same_view(v, c.camera); });
  constexpr float kLabelWidth = 68;
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

float view_cards_height(const Studio& studio, const ImVec2& room) {
  const CutRun* run = run_with_cards(studio);
  return run ? std::min(room.y, grid_of(*run, room).height()) : 0;
}

void view_cards(UiContext& ui, const ImVec2& room) {
  const CutRun* run = run_with_cards(ui.studio);
  if (!run) return;
  const CardGrid grid = grid_of(*run, room);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  int place = 0;
  for (std::size_t i = 0; i < run->views.size(); ++i) {
    if (!run->views[i].picture) continue;
    const ImVec2 size = card_size(run->views[i], grid.cell);
    const int in_row = place % grid.columns, above = place / grid.columns;
    const auto column = static_cast<float>(in_row), row = static_cast<float>(above);
    ImGui::SetCursorScreenPos(
        {from.x + column * (grid.cell.x + kCardGap) + std::round(0.5f * (grid.cell.x - size.x)),
         from.y + row * (grid.cell.y + kCardGap) + std::round(0.5f * (grid.cell.y - size.y))});
    card(ui, *run, *ui.studio.document().active_object(), run->views[i], i, size);
    ++place;
  }
}

}  // namespace splatcut
