// Where a badge with a sign lies on an outline: on its border, away from other badges and from what covers
// the picture. All in one unit, points of the screen.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace splatcut {

struct BadgeRoom {
  glm::vec2 min{0}, max{0};  // the whole badge lies within
  struct Bar {
    glm::vec2 min{0}, max{0};  // none where both are equal
  };
  std::array<Bar, 2> bars = {};  // it lies beside these
};

// The point of the border that is farthest from all in `apart`, the first of those that are far enough. Where
// a badge would touch another on all of a tiny border, a place beside it. None: the room holds no such place.
std::optional<glm::vec2> badge_place(std::span<const glm::vec2> border, std::span<const glm::vec2> apart,
                                     const BadgeRoom& room);

}  // namespace splatcut
