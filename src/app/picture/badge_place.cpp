#include "app/picture/badge_place.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

std::optional<glm::vec2> badge_place(std::span<const glm::vec2> border, std::span<const glm::vec2> apart,
                                     const BadgeRoom& room) {
  constexpr float kMargin = 16, kFarEnough = 60;
  const auto within = [](const glm::vec2& p, const glm::vec2& min, const glm::vec2& max) {
    return glm::all(glm::greaterThan(p, min)) && glm::all(glm::lessThan(p, max));
  };
  const auto fits = [&](const glm::vec2& p) {
    return within(p, room.min + kMargin, room.max - kMargin) &&
           std::ranges::none_of(room.bars, [&](const BadgeRoom::Bar& bar) {
             return bar.min != bar.max && within(p, bar.min - kMargin, bar.max + kMargin);
           });
  };
  std::optional<glm::vec2> best;
  float farthest = -1;
  for (const glm::vec2& p : border) {
    if (!fits(p)) continue;
    float distance = kFarEnough;
    for (const glm::vec2& q : apart) distance = std::min(distance, glm::distance(p, q));
    if (distance <= farthest) continue;
    farthest = distance;
    best = p;
  }
  constexpr float kTouches = 24;  // of two badges, 11 points in radius; a click's dot is smaller
  if (!best || farthest >= kTouches) return best;
  const auto is_free = [&](const glm::vec2& p) {
    return fits(p) &&
           std::ranges::all_of(apart, [&](const glm::vec2& q) { return glm::distance(p, q) >= kTouches; });
  };
  constexpr int kDirections = 16;
  for (const float away : {1.0f, 1.5f, 2.0f})
    for (int i = 0; i < kDirections; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / kDirections;
      const glm::vec2 beside = *best + away * kTouches * glm::vec2(std::cos(angle), std::sin(angle));
      if (is_free(beside)) return beside;
    }
  return {};
}

}  // namespace splatcut
