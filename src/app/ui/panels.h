// The panels: each draws itself into the current ImGui window from a const view and asks for what was
// clicked.
#pragma once

#include "app/ui/ui_context.h"

namespace splatcut {

struct UiRect {
  glm::vec2 min{0}, max{0};  // logical points
  glm::vec2 size() const { return max - min; }
  bool contains(const glm::vec2& p) const {
    return p.x >= min.x && p.y >= min.y && p.x < max.x && p.y < max.y;
  }
};

inline constexpr float kOptionsHeight = 44;  // of their row under the bar, where they have one

void top_bar(UiContext& ui);
void tool_options(UiContext& ui);
void turntable_button(UiContext& ui, const char* label, float width);
void tool_column(UiContext& ui);
void objects_panel(UiContext& ui);
void cutout_panel(UiContext& ui);
void repair_panel(UiContext& ui);
void scene_panel(UiContext& ui);
void files_panel(UiContext& ui);  // what the scene is made of
void history_panel(UiContext& ui);
void view_strip(UiContext& ui);
float view_strip_width(const Studio& studio);   // of all its cards, points; 0: none
float view_strip_height(const Studio& studio);  // as it is, or would be
void status_bar(UiContext& ui);

// Pictures, strokes, tool shapes, messages; these stay above the lowest `bottom` points. Returns what covers
// the picture and takes clicks itself.
std::vector<UiRect> viewport_pane(UiContext& ui, const UiRect& area, float bottom,
                                  ImTextureID gpu_picture[2]);
void start_page(UiContext& ui, const UiRect& area);

// Over the picture, whose pixels are pixels_per_point to a point.
void draw_strokes(const UiContext& ui, const UiRect& area);
// Other meanings of a click, with their keys. bar: that with their buttons, which covers no key.
void draw_offer(const UiContext& ui, const UiRect& area, float bottom, const UiRect& bar);
void draw_sizes(const UiContext& ui, const UiRect& area, float bottom, const UiRect& bar);  // the next ones
void draw_tool_shape(const UiContext& ui, const UiRect& area);
void draw_brush_ring(const UiContext& ui, const UiRect& area);
void draw_points(const UiContext& ui, const UiRect& area);  // of the ground, of what is measured
// Of the Gaussians that a pane shows; area: the pane's.
void draw_centres(const UiContext& ui, const UiRect& area, int pane);
void draw_rings(const UiContext& ui, const UiRect& area, int pane);
void draw_ground_grid(const UiContext& ui, const UiRect& area, int pane);
void draw_unseen_ground(const UiContext& ui, const UiRect& area,
                        const std::vector<std::pair<glm::vec3, glm::vec3>>& outline_world);
// The file that is chosen in the files panel: where it would stand, and handles that move it.
void draw_placed_file(UiContext& ui, const UiRect& area);
void draw_key_cursor(const UiContext& ui, const UiRect& area);   // that the arrows move
void draw_cursor_sign(const UiContext& ui, const UiRect& area);  // what a press would do to the selection
inline constexpr float kAxesWidth = 98;                // that axes_gizmo() takes, its margin counted; points
UiRect axes_gizmo(UiContext& ui, const UiRect& area);  // which takes clicks: look along an axis

void help_page(UiContext& ui);
float keys_width();  // of the keys on that page, beside which it says what they do; points
void settings_page(UiContext& ui);
void export_dialog(UiContext& ui);
// What is exported as it will stand in the file, with handles; a picture in the dialog, of that size.
void export_preview(UiContext& ui, const glm::vec2& size_points);
void turntable_dialog(UiContext& ui);
void quit_dialog(UiContext& ui);
void open_anyway_dialog(UiContext& ui);
void left_work_list(UiContext& ui);  // work that crashes left
void recent_list(UiContext& ui);
void file_dialog(UiContext& ui);  // and what follows from the choice
void replace_dialog(UiContext& ui);
void open_file_dialog(UiContext& ui, FilePurpose purpose);

}  // namespace splatcut
