#include "app/window/interface.h"

#include <imgui_internal.h>  // ClosePopupsExceptModals

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"
#include "app/viewport/viewport_pane.h"

namespace splatcut {

namespace {

constexpr float kTopHeight = 46, kToolsWidth = 54, kUsualSideWidth = 316;

bool is_small(const glm::vec2& window_size) {
  return window_size.x < 880;
}

// A third of a small window, so that the picture keeps the most of it.
float side_width(const glm::vec2& window_size) {
  return is_small(window_size) ? std::round(window_size.x / 3) : kUsualSideWidth;
}

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;

// ImGui puts windows that do not come to the front behind those made before them.
constexpr ImGuiWindowFlags kOverPicture =
    (kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_NoFocusOnAppearing;

// A panel that fills a rectangle.
template <class Content>
void fixed_panel(const char* name, const UiRect& rect, const Palette& palette, ImGuiWindowFlags flags,
                 const ImVec2& padding, const Content& content) {
  ImGui::SetNextWindowPos({rect.min.x, rect.min.y});
  ImGui::SetNextWindowSize({rect.size().x, rect.size().y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette.panel);
  ImGui::Begin(name, nullptr, flags);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
  content();
  ImGui::End();
}

constexpr ImGuiHoveredFlags kAlsoDragged =
    ImGuiHoveredFlags_AllowWhenBlockedByActiveItem | ImGuiHoveredFlags_AllowWhenBlockedByPopup;

// Rows of a panel that come and go by themselves. With `held`, and while the pointer is at the rows below
// them, they keep their height, so that no button moves as one aims at it; what has no room comes once the
// pointer has left. below_end: where those rows ended in the last frame; under them there is nothing to aim
// at.
template <class Content>
void steady_rows(float* height, bool held, float below_end, const Content& content) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float pointer = ImGui::GetIO().MousePos.y;
  const bool keeps = held && *height > 0 && ImGui::IsWindowHovered(kAlsoDragged) &&
                     pointer >= from.y + *height && pointer < below_end;
  const ImVec2 end = {from.x + ImGui::GetContentRegionAvail().x,
                      keeps ? from.y + *height : std::numeric_limits<float>::max()};
  ImGui::PushClipRect({ImGui::GetWindowPos().x, ImGui::GetWindowPos().y}, end, true);
  content();
  ImGui::PopClipRect();
  if (!keeps) *height = ImGui::GetCursorScreenPos().y - from.y;
  ImGui::SetCursorScreenPos({from.x, from.y + *height});
}

// What comes and goes by itself stands at the panel's lower end, where it moves no row: notes, and under them
// thumbnails, each as high as it is, up to a share of the panel; more of them scroll.
float notes_room(float height, float cards) {
  constexpr float kMost = 0.35f, kMostWithCards = 0.55f;
  const float room = ImGui::GetContentRegionAvail().y;
  return std::min({height, kMost * room, kMostWithCards * room - cards});
}

ImVec2 cards_room() {
  constexpr float kMost = 0.35f;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  return {room.x, std::floor(kMost * room.y)};
}

// height: of all of them, points.
void notes_below(UiContext& ui, float room, bool thumbnails, float* height) {
  ImGui::BeginChild("notes", {0, room});
  cut_notes(ui, thumbnails);
  *height = ImGui::GetCursorPosY();
  ImGui::EndChild();
}

// A pointer that merely lies somewhere while keys are pressed aims at nothing.
bool pointer_aims(bool aimed) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0) return true;
  const float* const keys = io.KeysDownDuration;  // 0: pressed since the last frame; modifiers come last
  return aimed && std::find(keys, keys + key::kLeftShift, 0.0f) == keys + key::kLeftShift;
}

void line(const glm::vec2& a, const glm::vec2& b, const Palette& palette) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  list.AddLine({a.x, a.y}, {b.x, b.y}, packed(palette.line, 0.8f));
  list.PopClipRect();
}

void borders(const glm::vec2& size, float side, const Palette& palette) {
  const float bottom = size.y - kStatusHeight;
  line({0, kTopHeight}, {size.x, kTopHeight}, palette);
  line({kToolsWidth, kTopHeight}, {kToolsWidth, bottom}, palette);
  line({side, kTopHeight}, {side, bottom}, palette);
  line({0, bottom}, {size.x, bottom}, palette);
}

}  // namespace

Interface::Interface() : context_(ImGui::CreateContext()) {
  make_current();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigDragClickToInputText = true;  // a double-click may fall between two frames
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

Interface::~Interface() {
  ImGui::DestroyContext(context_);
}

void Interface::make_current() {
  ImGui::SetCurrentContext(context_);
}

void Interface::resize(const glm::vec2& size_points, float pixels_per_point, UiRenderer* renderer) {
  make_current();
  size_points_ = size_points;
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {size_points.x, size_points.y};
  io.DisplayFramebufferScale = {pixels_per_point, pixels_per_point};
  if (theme_.body && theme_.pixels_per_point == pixels_per_point) return;
  load_fonts(&theme_, pixels_per_point);
  renderer->upload_fonts();
  apply_theme(&theme_, state_.dark);
}

UiRect Interface::viewport() const {
  const float bottom = size_points_.y - kStatusHeight;
  const auto whole = [&](float v) {
    return std::round(v * theme_.pixels_per_point) / theme_.pixels_per_point;
  };
  return {{kToolsWidth, kTopHeight},
          {whole(std::max(kToolsWidth + 1, size_points_.x - (has_side_ ? side_width(size_points_) : 0))),
           whole(std::max(kTopHeight + 1, bottom))}};
}

bool Interface::dialog_open() const {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

bool Interface::picture_at(const glm::vec2& point, const Studio& studio) const {
  if (!studio.scene() || dialog_open() || !viewport().contains(point)) return false;
  return std::ranges::none_of(covered_, [&](const UiRect& r) { return r.contains(point); });
}

bool Interface::handle_at(const glm::vec2& point) const {
  return state_.placing.grips.at(point);
}

void Interface::build(const Studio& studio, double seconds, UiRenderer* renderer, ImTextureID gpu_picture[2],
                      Requests* ask) {
  make_current();
  if (theme_.dark != state_.dark) apply_theme(&theme_, state_.dark);
  ImGuiIO& io = ImGui::GetIO();
  io.DeltaTime = static_cast<float>(std::max(1e-4, seconds));
  io.ConfigInputTextCursorBlink = !state_.steady;
  ImGui::NewFrame();
  if (ImGui::IsKeyPressed(key::kEscape, false)) ImGui::ClosePopupsExceptModals();  // menus, lists, pickers
  ImGui::PushFont(theme_.body);
  UiContext ui{studio, state_, *ask, theme_, *renderer};
  const Palette& p = theme_.colour;
  const glm::vec2 size = size_points_;
  // Before there is a scene the panel has nothing to say, and a small window no room for that.
  has_side_ = !is_small(size) || studio.scene() || !studio.coming().empty();
  const UiRect view = viewport();
  state_.items = {{"picture", view.min, view.max}};
  fixed_panel("picture", view, p, kFixed | ImGuiWindowFlags_NoScrollWithMouse, {0, 0}, [&] {
    covered_ = viewport_pane(ui, view, gpu_picture);
    if (!dialog_open()) borders(size, view.max.x, p);  // over all panels, under tooltips
  });
  fixed_panel("bar", {{0, 0}, {size.x, kTopHeight}}, p, kFixed | ImGuiWindowFlags_NoScrollWithMouse, {9, 9},
              [&] { top_bar(ui); });
  if (state_.row_below()) {  // over the picture, under the bar
    const float most_width = state_.options_below ? 600 : 310;
    const UiRect row = {view.min,
                        {std::min(view.max.x, view.min.x + most_width), view.min.y + state_.options_height}};
    fixed_panel("options", row, p, kOverPicture | ImGuiWindowFlags_NoBackground, {9, 8}, [&] {
      ImDrawList& list = *ImGui::GetWindowDrawList();
      list.ChannelsSplit(2);
      list.ChannelsSetCurrent(1);
      ImGui::BeginGroup();
      options_row(ui);
      const ImVec2 last_min = ImGui::GetItemRectMin(), last_max = ImGui::GetItemRectMax();
      ImGui::EndGroup();
      state_.options_height =
          std::max(kOptionsHeight, ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y + 8);
      // Beside the options, and beside the last line of several, the picture shows and takes what is drawn.
      constexpr float kPad = 9, kAbove = 4;
      const float end = std::min(row.max.x, ImGui::GetItemRectMax().x + kPad),
                  last_line = std::max(row.min.y, last_min.y - kAbove);
      const bool several = last_min.y > ImGui::GetItemRectMin().y + ImGui::GetFrameHeight();
      list.ChannelsSetCurrent(0);
      for (const UiRect& part :
           {UiRect{row.min, {end, several ? last_line : row.min.y + state_.options_height}},
            UiRect{{row.min.x, last_line},
                   {std::min(row.max.x, last_max.x + kPad), row.min.y + state_.options_height}}}) {
        covered_.push_back(part);
        list.AddRectFilled({part.min.x, part.min.y}, {part.max.x, part.max.y}, packed(p.panel));
      }
      list.ChannelsMerge();
    });
  }
  fixed_panel("tools", {{0, kTopHeight}, {kToolsWidth, size.y - kStatusHeight}}, p, kFixed, {8, 8},
              [&] { tool_column(ui); });
  if (has_side_)
    fixed_panel("side", {{size.x - side_width(size), kTopHeight}, {size.x, size.y - kStatusHeight}}, p,
                kFixed, {12, 8}, [&] { side_panel(ui); });
  fixed_panel("status", {{0, size.y - kStatusHeight}, {size.x, size.y}}, p,
              kFixed | ImGuiWindowFlags_NoScrollWithMouse, {12, 3}, [&] { status_bar(ui); });
  dialogs(ui);
  if (const auto& m = state_.marked)
    ImGui::GetForegroundDrawList()->AddRect({m->min.x - 2, m->min.y - 2}, {m->max.x + 2, m->max.y + 2},
                                            packed(p.text), 7, 0, 2);
  ImGui::PopFont();
  ImGui::Render();
}

// A question about unsaved work is seen at once: pages close for it, and other dialogs, which stay wanted,
// come back as they were once it is answered. Leaving is asked before opening.
void Interface::dialogs(UiContext& ui) {
  if (state_.quit_asked || state_.open_asked) {
    state_.help_open = state_.settings_open = false;
    return state_.quit_asked ? quit_dialog(ui) : open_anyway_dialog(ui);
  }
  file_dialog(ui);
  replace_dialog(ui);
  export_dialog(ui);
  turntable_dialog(ui);
  help_page(ui);
  settings_page(ui);
}

void Interface::side_panel(UiContext& ui) {
  const ImVec2 for_cards = cards_room();
  pointer_aims_ = pointer_aims(pointer_aims_);
  // No thumbnail comes, goes or moves as one aims at it or at a row.
  if (!pointer_aims_ || !ImGui::IsWindowHovered(kAlsoDragged | ImGuiHoveredFlags_ChildWindows))
    cards_height_ = view_cards_height(ui.studio, for_cards);
  const float notes =
      has_cut_notes(ui.studio, cards_height_ > 0) ? notes_room(notes_height_, cards_height_) : 0;
  const float between = notes > 0 && cards_height_ > 0 ? ImGui::GetStyle().ItemSpacing.y : 0;
  const float below = notes + between + cards_height_;
  begin_side_rows(below);
  steady_rows(&objects_height_, pointer_aims_, side_end_, [&] { objects_panel(ui); });
  steady_rows(&cutout_height_, pointer_aims_, side_end_, [&] { cutout_panel(ui); });
  repair_panel(ui);
  scene_panel(ui);
  files_panel(ui);
  history_panel(ui);
  side_end_ = ImGui::GetCursorScreenPos().y;
  side_scrolls_ = ImGui::GetScrollMaxY() > 0;
  ImGui::EndChild();
  ImGui::PopClipRect();
  if (below > 0) ImGui::Separator();
  if (notes > 0) notes_below(ui, notes, cards_height_ > 0, &notes_height_);
  if (cards_height_ <= 0) return;
  ImGui::BeginChild("cards", {0, cards_height_});
  view_cards(ui, for_cards);
  ImGui::EndChild();
}

// Their width is the same with a bar to scroll by and without: it lies in the panel's margin.
void Interface::begin_side_rows(float below) const {
  const ImVec2 panel = ImGui::GetWindowPos(), size = ImGui::GetWindowSize(),
               room = ImGui::GetContentRegionAvail();
  const float with_line = below + 2 * ImGui::GetStyle().ItemSpacing.y;
  ImGui::PushClipRect(panel, {panel.x + size.x, panel.y + size.y}, false);
  if (!side_scrolls_) ImGui::PushStyleColor(ImGuiCol_ScrollbarGrab, {0, 0, 0, 0});
  ImGui::BeginChild("scroll", {room.x + ImGui::GetStyle().ScrollbarSize, below > 0 ? -with_line : 0}, false,
                    ImGuiWindowFlags_AlwaysVerticalScrollbar);
  if (!side_scrolls_) ImGui::PopStyleColor();
}

void Interface::show(UiRequest request, const Studio& studio, UiRenderer* renderer) {
  make_current();
  Requests ignored;
  UiContext ui{studio, state_, ignored, theme_, *renderer};
  switch (request) {
    case UiRequest::kOpenDialog:
      return open_file_dialog(ui, FilePurpose::kOpen);
    case UiRequest::kAddDialog:
      return open_file_dialog(ui, FilePurpose::kAdd);
    case UiRequest::kSaveDialog:
      state_.after_save.reset();
      return open_file_dialog(ui, FilePurpose::kSaveWork);
    case UiRequest::kSnapshotDialog:
      return open_file_dialog(ui, FilePurpose::kSnapshot);
    case UiRequest::kExportDialog:
      state_.exporting.path.clear();
      state_.exporting.trouble.clear();
      state_.exporting.overwrite = false;
      state_.exporting.name_first = true;
      if (const OpenedScene* scene = studio.scene())
        if (std::exchange(state_.exporting.placed_file, scene->files.front().id) != scene->files.front().id)
          state_.exporting.placement = {};
      state_.export_open = true;
      return;
    case UiRequest::kExportFailed:
      state_.exporting.trouble = studio.messages().empty() ? "" : studio.messages().back().text;
      state_.exporting.tried.reset();
      state_.export_open = true;
      return;
    case UiRequest::kFillKept:
      state_.placing.files_before = studio.scene()->files.size();
      return;
    case UiRequest::kHelp:
      state_.help_open = true;
      return;
    case UiRequest::kSettings:
      state_.settings_open = true;
      return;
    case UiRequest::kTheme:
      state_.dark = !state_.dark;
      return;
    case UiRequest::kHistory:
      state_.history_wanted = !state_.history_open;
      return;
    case UiRequest::kQuit:
      if (studio.unsaved_and_not_exported() || studio.exporting())
        state_.quit_asked = true;
      else
        state_.quit_wanted = true;
  }
}

}  // namespace splatcut
