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

constexpr float kTopHeight = 46, kToolsWidth = 54, kUsualSideWidth = 316, kStatus = 30;

// A third of a small window, so that the picture keeps the most of it.
float side_width(const glm::vec2& window_size) {
  return window_size.x < 880 ? std::round(window_size.x / 3) : kUsualSideWidth;
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

// Rows of a panel that come and go by themselves. With `held`, and while the pointer is at the rows below
// them, they keep their height, so that no button moves as one aims at it; what has no room comes once the
// pointer has left. below_end: where those rows ended in the last frame; under them there is nothing to aim
// at.
template <class Content>
void steady_rows(float* height, bool held, float below_end, const Content& content) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  constexpr ImGuiHoveredFlags kAlsoDragged =
      ImGuiHoveredFlags_AllowWhenBlockedByActiveItem | ImGuiHoveredFlags_AllowWhenBlockedByPopup;
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

// What comes and goes by itself stands at the panel's lower end, where it moves no row.
// height: in the last frame, points.
void notes_below(UiContext& ui, float* height) {
  ImGui::Separator();
  ImGui::BeginChild("notes");
  cut_notes(ui);
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
  ImGui::GetForegroundDrawList()->AddLine({a.x, a.y}, {b.x, b.y}, packed(palette.line, 0.8f));
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
  const float bottom = size_points_.y - kStatus;
  const auto whole = [&](float v) {
    return std::round(v * theme_.pixels_per_point) / theme_.pixels_per_point;
  };
  return {{kToolsWidth, kTopHeight},
          {whole(std::max(kToolsWidth + 1, size_points_.x - side_width(size_points_))),
           whole(std::max(kTopHeight + 1, bottom))}};
}

bool Interface::dialog_open() const {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

float Interface::covered_bottom(const Studio& studio) const {
  return view_strip_width(studio) > 0 ? kept_bottom(studio) : 0;
}

float Interface::kept_bottom(const Studio& studio) const {
  return view_strip_height(studio);
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
  const UiRect view = viewport();
  state_.items = {{"picture", view.min, view.max}};
  const float cards = view_strip_width(studio);
  fixed_panel("picture", view, p, kFixed | ImGuiWindowFlags_NoScrollWithMouse, {0, 0},
              [&] { covered_ = viewport_pane(ui, view, covered_bottom(studio), gpu_picture); });
  fixed_panel("bar", {{0, 0}, {size.x, kTopHeight}}, p, kFixed | ImGuiWindowFlags_NoScrollWithMouse, {9, 9},
              [&] { top_bar(ui); });
  if (state_.row_below()) {  // over the picture, under the bar
    const float most_width = state_.options_below ? 600 : 310;
    const UiRect row = {view.min,
                        {std::min(view.max.x, view.min.x + most_width), view.min.y + state_.options_height}};
    covered_.push_back(row);
    fixed_panel("options", row, p, kOverPicture, {9, 8}, [&] {
      options_row(ui);
      state_.options_height =
          std::max(kOptionsHeight, ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y + 8);
    });
  }
  fixed_panel("tools", {{0, kTopHeight}, {kToolsWidth, size.y - kStatus}}, p, kFixed, {8, 8},
              [&] { tool_column(ui); });
  fixed_panel("side", {{size.x - side_width(size), kTopHeight}, {size.x, size.y - kStatus}}, p, kFixed,
              {12, 8}, [&] {
                const bool notes = has_cut_notes(studio);
                begin_side_rows(notes ? notes_height_ : 0);
                pointer_aims_ = pointer_aims(pointer_aims_);
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
                if (notes) notes_below(ui, &notes_height_);
              });
  if (cards > 0) {  // no wider than it must be: it lies on the picture
    constexpr glm::vec2 kStripPadding(8, 7);
    const float right = std::min(view.max.x, view.min.x + std::ceil(cards) + 2 * kStripPadding.x);
    const UiRect strip = {{view.min.x, view.max.y - kept_bottom(studio)}, {right, view.max.y}};
    covered_.push_back(strip);
    Palette clear = p;
    clear.panel.w = 0.9f;
    fixed_panel("strip", strip, clear, kOverPicture, {kStripPadding.x, kStripPadding.y}, [&] {
      ImGui::BeginChild("cards", {0, 0}, false, ImGuiWindowFlags_HorizontalScrollbar);
      view_strip(ui);
      if (ImGui::IsWindowHovered()) ImGui::SetScrollX(ImGui::GetScrollX() - 60 * io.MouseWheel);
      ImGui::EndChild();
    });
  }
  fixed_panel("status", {{0, size.y - kStatus}, {size.x, size.y}}, p,
              kFixed | ImGuiWindowFlags_NoScrollWithMouse, {12, 3}, [&] { status_bar(ui); });
  if (!dialog_open()) {
    line({0, kTopHeight}, {size.x, kTopHeight}, p);
    line({kToolsWidth, kTopHeight}, {kToolsWidth, size.y - kStatus}, p);
    line({size.x - side_width(size), kTopHeight}, {size.x - side_width(size), size.y - kStatus}, p);
    line({0, size.y - kStatus}, {size.x, size.y - kStatus}, p);
  }
  file_dialog(ui);
  replace_dialog(ui);
  export_dialog(ui);
  turntable_dialog(ui);
  help_page(ui);
  settings_page(ui);
  quit_dialog(ui);
  open_anyway_dialog(ui);
  if (const auto& m = state_.marked)
    ImGui::GetForegroundDrawList()->AddRect({m->min.x - 2, m->min.y - 2}, {m->max.x + 2, m->max.y + 2},
                                            packed(p.text), 7, 0, 2);
  ImGui::PopFont();
  ImGui::Render();
}

// Their width is the same with a bar to scroll by and without: it lies in the panel's margin.
void Interface::begin_side_rows(float notes_height) const {
  constexpr float kMostNotes = 0.35f;  // of the panel; more of them scroll
  const ImVec2 panel = ImGui::GetWindowPos(), size = ImGui::GetWindowSize(),
               room = ImGui::GetContentRegionAvail();
  const float notes = std::min(notes_height, kMostNotes * room.y) + 2 * ImGui::GetStyle().ItemSpacing.y;
  ImGui::PushClipRect(panel, {panel.x + size.x, panel.y + size.y}, false);
  if (!side_scrolls_) ImGui::PushStyleColor(ImGuiCol_ScrollbarGrab, {0, 0, 0, 0});
  ImGui::BeginChild("scroll", {room.x + ImGui::GetStyle().ScrollbarSize, notes_height > 0 ? -notes : 0},
                    false, ImGuiWindowFlags_AlwaysVerticalScrollbar);
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
      if (studio.unsaved() || studio.exporting())
        state_.quit_asked = true;
      else
        state_.quit_wanted = true;
  }
}

}  // namespace splatcut
