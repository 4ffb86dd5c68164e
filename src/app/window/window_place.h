// Where the window opens and how large: as it was left, as far as the screens of now have room for it.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace splatcut {

// What a window may cover of a screen, in screen coordinates.
struct Screen {
  glm::ivec2 at{0}, size{0};
  glm::vec2 scale{1};
};

struct WindowPlace {
  glm::ivec2 size{0};
  std::optional<glm::ivec2> position;  // of the contents; where the system likes without
  bool maximized = false;
  bool scaled = false;  // the size is in points of an ordinary screen, not in this one's
};

// screens: the first is the one that windows open on by themselves. Screens come and go between runs: the
// position is dropped where none has the middle of the title bar; the size is cut to the screen that has it,
// beside its bars and the window's frame.
WindowPlace fitting(WindowPlace wanted, std::span<const Screen> screens);

}  // namespace splatcut
