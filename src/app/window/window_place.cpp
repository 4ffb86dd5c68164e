#include "app/window/window_place.h"

#include <algorithm>

namespace splatcut {

namespace {

bool can_be_reached(const Screen& screen, const glm::ivec2& position, int width) {
  constexpr int kTitleBar = 16;
  const glm::ivec2 in = position + glm::ivec2(width / 2, -kTitleBar / 2) - screen.at;
  return in.x >= 0 && in.y >= -kTitleBar && in.x < screen.size.x && in.y < screen.size.y;
}

}  // namespace

WindowPlace fitting(WindowPlace wanted, std::span<const Screen> screens) {
  constexpr int kFrame = 40;
  if (screens.empty()) return wanted;
  auto screen = screens.begin();
  if (wanted.position) {
    const auto holds = std::ranges::find_if(
        screens, [&](const Screen& s) { return can_be_reached(s, *wanted.position, wanted.size.x); });
    if (holds == screens.end())
      wanted.position.reset();
    else
      screen = holds;
  }
  const glm::vec2 scale = wanted.scaled ? glm::max(screen->scale, 1.0f) : glm::vec2(1);
  const glm::vec2 most = glm::vec2(screen->size - kFrame) / scale;
  wanted.size = glm::max(glm::min(wanted.size, glm::ivec2(most)), glm::ivec2(480, 360));
  return wanted;
}

}  // namespace splatcut
