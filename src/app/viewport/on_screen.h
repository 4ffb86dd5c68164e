// From pixels of the picture to points on the screen.
#pragma once

#include "app/ui/ui_context.h"

namespace splatcut {

struct OnScreen {
  glm::vec2 origin;  // of the picture, points
  float points_per_pixel;
  ImVec2 operator()(const glm::vec2& pixel) const {
    const glm::vec2 at = origin + pixel * points_per_pixel;
    return {at.x, at.y};
  }
};

inline OnScreen on_screen(const UiContext& ui, const UiRect& area) {
  return {area.min, 1 / ui.theme.pixels_per_point};
}

// Where a press would go in the picture: at the cursor of the arrows, else at the mouse; none: at neither.
std::optional<ImVec2> pointed_at(const UiContext& ui, const UiRect& area);

}  // namespace splatcut
