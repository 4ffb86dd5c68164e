// The picture of the scene and all that is drawn over it and pressed on it.
#pragma once

#include "app/ui/ui_context.h"

namespace splatcut {

// Pictures, strokes, tool shapes, messages. Returns what covers the picture and takes clicks itself.
std::vector<UiRect> viewport_pane(UiContext& ui, const UiRect& area, ImTextureID gpu_picture[2]);

// Over the picture, whose pixels are pixels_per_point to a point.
void draw_strokes(const UiContext& ui, const UiRect& area);
// Other meanings of a click, with their keys. bar: that with their buttons, which covers no key.
void draw_offer(const UiContext& ui, const UiRect& area, const UiRect& bar);
void draw_sizes(const UiContext& ui, const UiRect& area, const UiRect& bar);  // the next ones
void draw_tool_shape(const UiContext& ui, const UiRect& area);
void draw_brush_ring(const UiContext& ui, const UiRect& area);
void draw_points(const UiContext& ui, const UiRect& area);  // of the ground, of what is measured
// Of the Gaussians that a pane shows; area: the pane's.
void draw_centres(const UiContext& ui, const UiRect& area, int pane);
void draw_rings(const UiContext& ui, const UiRect& area, int pane);
void draw_ground_grid(const UiContext& ui, const UiRect& area, int pane);
void draw_ground_outline(const UiContext& ui, const UiRect& area,
                         const std::vector<std::pair<glm::vec3, glm::vec3>>& outline_world);
// The file that is chosen in the files panel: where it would stand, and handles that move it.
void draw_placed_file(UiContext& ui, const UiRect& area);
void draw_key_cursor(const UiContext& ui, const UiRect& area);   // that the arrows move
void draw_looking(const UiContext& ui, const UiRect& area);      // at the pointer, while that takes long
void draw_cursor_sign(const UiContext& ui, const UiRect& area);  // what a press would do to the selection
inline constexpr float kAxesWidth = 98;  // that axes_gizmo() takes, its margin counted; points
UiRect axes_gizmo(UiContext& ui,
                  const UiRect& area);  // look along an axis by a click, unless a shape is begun

}  // namespace splatcut
