#include "app/picture/badge_place.h"

#include <algorithm>

namespace splatcut {

std::optional<glm::vec2> badge_place(std::span<const glm::vec2> border, std::span<const glm::vec2> apart,
                                     const BadgeRoom& room) {
  constexpr float kMargin = 16, kFarEnough = 60;
  const auto within = [](const glm::vec2& p, const glm::vec2& min, const glm::vec2& max) {
    return glm::all(glm::greaterThan(p, min)) && glm::all(glm::lessThan(p, max));
  };
  const bool bar = room.bar_min != room.bar_max;
  std::optional<glm::vec2> best;
  float farthest = -1;
  for (const glm::vec2& p : border) {
    if (!within(p, room.min + kMargin, room.max - kMargin)) continue;
    if (bar && within(p, room.bar_min - kMargin, room.bar_max + kMargin)) continue;
    float distance = kFarEnough;
    for (const glm::vec2& q : apart) distance = std::min(distance, glm::distance(p, q));
    if (distance <= farthest) continue;
    farthest = distance;
    best = p;
  }
  return best;
}

}  // namespace splatcut
