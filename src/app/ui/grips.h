// Placing handles on the screen: drawn, taken by the left button, dragged.
#pragma once

#include <imgui.h>

#include <optional>
#include <vector>

#include "app/placing/placing_handles.h"

namespace splatcut {

struct Theme;

// Kept from frame to frame.
struct Grips {
  std::vector<PlacingHandle> shown;  // as of the last frame, points of the window; empty: none
  struct Drag {
    PlacingHandles handles;
    PlacingHandle handle;
    Camera camera;
    glm::vec2 from{0};
  };
  std::optional<Drag> drag;

  bool at(const glm::vec2& point) const;  // of the window
};

struct GripsMoved {
  std::optional<PlacingChange> change;  // since the drag began, while it lasts and as it ends
  bool began = false, done = false;     // done: the button was released
};

// camera: its pixels are points of the window. free: nothing else takes the pointer. Esc ends a drag with the
// change taken back.
GripsMoved grips(Grips* grips, const PlacingHandles& handles, const Camera& camera, bool free,
                 const Theme& theme);

// The camera whose pixels are points of the window, where the picture begins at `origin`.
Camera in_window_points(const Camera& camera, const glm::vec2& origin, float pixels_per_point);

}  // namespace splatcut
