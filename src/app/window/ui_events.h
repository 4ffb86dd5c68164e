// What reaches the interface from outside: the same for a real window and for tests. Positions are logical
// points from the top left of the window.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <variant>

#include "app/tools/actions.h"
#include "app/tools/pointer_tools.h"

namespace splatcut {

struct PointerMoved {
  glm::vec2 position_points{0};
  Modifiers modifiers;
};
struct PointerButtonChanged {
  PointerButton button = PointerButton::kLeft;
  bool down = false;
  Modifiers modifiers;
  // Time when the window took the event from the system's queue, on any clock; none: at this frame. GLFW does
  // not say when the hand did it: during a frame, events wait.
  std::optional<double> time_s = {};
};
struct PointerLeft {};  // the pointer left the window
struct WheelTurned {
  float steps = 0;
  Modifiers modifiers;
};
struct KeyChanged {
  int key = 0;
  bool down = false, repeated = false;
  Modifiers modifiers;
};
struct TextTyped {
  unsigned code_point = 0;
};
struct FileDropped {
  std::filesystem::path path;
  std::vector<std::filesystem::path> more;  // dropped with it
};
struct FocusChanged {
  bool focused = true;
};

using UiEvent = std::variant<PointerMoved, PointerButtonChanged, PointerLeft, WheelTurned, KeyChanged,
                             TextTyped, FileDropped, FocusChanged>;

}  // namespace splatcut
