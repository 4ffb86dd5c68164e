// Handles by which the pointer moves, turns and scales something in space.
//
// A ball at its middle follows the pointer at its depth, arrows move along axes, rings turn about them, a
// square beside the middle scales. The handles keep their size in the picture. Pixels are the camera's.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

struct PlacingHandles {
  glm::vec3 centre_world{0};          // what turning and scaling leave where it is
  std::vector<glm::vec3> arrow_axes;  // unit length
  std::vector<glm::vec3> turn_axes;   // unit length
  float reach_px = 84;                // of the rings, which lie around the arrows
  std::vector<float> turned_deg;      // about each of turn_axes, so far; steps are of the sum
  float scaled = 1;                   // so far; steps are of the product
};

enum class PlacingGrip { kMove, kMoveAlong, kTurn, kScale };

// One handle in the picture. The path: of kMove and kScale a point, of an arrow its ends, the tip last, of a
// ring the half that faces the camera, or all of it where it is seen from the front.
struct PlacingHandle {
  PlacingGrip grip = PlacingGrip::kMove;
  std::size_t axis = 0;  // of arrow_axes or turn_axes
  std::vector<glm::vec2> path_px;
};

// p' = scale turn (p - centre) + centre + move.
struct PlacingChange {
  glm::vec3 move_world{0};
  glm::quat turn{1, 0, 0, 0};
  float angle_rad = 0;  // of the turn, about its axis, -2 pi to 2 pi
  float scale = 1;      // > 0
};

// None where the centre is not in front of the camera. Arrows that point at the camera are left out: a drag
// would give no distance.
std::vector<PlacingHandle> handles_px(const PlacingHandles& handles, const Camera& camera);

// The handle nearest to the pixel, at most within_px away.
std::optional<std::size_t> handle_at(std::span<const PlacingHandle> shown, const glm::vec2& at_px,
                                     float within_px);

// What a drag of the handle from one pixel to another does. in_steps: to turns of 15 degrees, to tenths of
// the scale.
PlacingChange dragged(const PlacingHandles& handles, const PlacingHandle& handle, const glm::vec2& from_px,
                      const glm::vec2& to_px, const Camera& camera, bool in_steps);

}  // namespace splatcut
