// How the photographs of a capture show a point: from how far, and how much around it. Things are
// photographed whole; a user may stand so near that the picture crops them.
//
// A picture's breadth at a point: the side of a square as large as the picture's area there, scene units.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "scene/camera/camera.h"

namespace splatcut {

inline constexpr std::ptrdiff_t kEnoughPhotographs = 3;  // to know a place by them alone

struct Photographed {
  float distance = 0, breadth = 0;  // medians over the photographs that show the point, scene units
};

// Nothing where fewer than kEnoughPhotographs show the point.
std::optional<Photographed> photographed(std::span<const Camera> photographs, const glm::vec3& point_world);

// True if photographs show the point, and this picture so much less around it that it may not hold what is
// meant: its breadth there is less than two thirds of theirs.
bool is_close_up(const Camera& camera, std::span<const Camera> photographs, const glm::vec3& point_world);

// With these margins a picture that is_close_up() has the breadth of the photographs, or three times its own
// if that is less. None around another.
Margins margins_of_close_up(const Camera& camera, std::span<const Camera> photographs,
                            const glm::vec3& point_world);

}  // namespace splatcut
