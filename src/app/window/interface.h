// Lays out the panels and draws them with ImGui; owns the ImGui context. Knows no window and no OpenGL beyond
// textures. Main thread only.
#pragma once

#include <glm/glm.hpp>

#include "app/ui/ui_context.h"

struct ImGuiContext;

namespace splatcut {

class Interface {
 public:
  Interface();
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  void make_current();
  // size_points: of the window, in logical points. Loads the fonts again where the scale differs.
  void resize(const glm::vec2& size_points, float pixels_per_point, UiRenderer* renderer);

  // Where the picture is drawn, in points: on whole pixels.
  UiRect viewport() const;
  // True where a press at this point is meant for the picture.
  bool picture_at(const glm::vec2& point, const Studio& studio) const;
  // True where a left press takes a handle that lies on the picture.
  bool handle_at(const glm::vec2& point) const;
  bool dragging_handle() const { return state_.placing.grips.drag.has_value(); }  // Esc is for that
  bool dialog_open() const;

  // Builds the frame; its draw data is ImGui's until the next call.
  void build(const Studio& studio, double seconds, UiRenderer* renderer, ImTextureID gpu_picture[2],
             Requests* ask);

  // What the studio wants shown: dialogs, pages, themes.
  void show(UiRequest request, const Studio& studio, UiRenderer* renderer);

  UiState& state() { return state_; }
  const Theme& theme() const { return theme_; }

 private:
  void dialogs(UiContext& ui);
  void side_panel(UiContext& ui);
  void begin_side_rows(float below) const;

  ImGuiContext* context_;
  Theme theme_;
  UiState state_;
  glm::vec2 size_points_{1280, 720};
  float objects_height_ = 0, cutout_height_ = 0;  // of these sections in the side panel, points
  float notes_height_ = 28, cards_height_ = 0;    // of the notes and thumbnails below them, points
  float side_end_ = 0;                            // of the side panel's rows in the last frame
  bool side_scrolls_ = false;                     // they have no room
  bool has_side_ = true;                          // the side panel is there
  bool pointer_aims_ = false;                     // it was moved after the last key
  std::vector<UiRect> covered_;  // parts of the picture that take clicks themselves, as of the last frame
};

}  // namespace splatcut
