// Handles with which the pointer moves, turns and scales something in space.
//
// A ball in the middle follows the pointer at its own depth, arrows move along axes, rings turn about axes,
// and a square beside the middle scales. The handles keep their size in the picture. Pixels are the camera's.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/camera/camera.h"

namespace splatcut {

struct PlacingHandles {
  glm::vec3 centre_world{0};          // point that turning and scaling leave in place
  std::vector<glm::vec3> arrow_axes;  // axes of the arrows, world, unit length
  std::vector<glm::vec3> turn_axes;   // axes of the rings, world, unit length
  float reach_px = 84;                // radius of the rings, which lie around the arrows
  std::vector<float> turned_deg;      // angle about each of turn_axes so far: steps round the sum
  float scaled = 1;                   // scale so far: steps round the product
};

enum class PlacingGrip { kMove, kMoveAlong, kTurn, kScale };

// One handle in the picture. The path of kMove and kScale is a point. That of an arrow is its two ends, the
// tip last. That of a ring is the half that faces the camera, or the whole ring if the camera looks along its
// axis.
struct PlacingHandle {
  PlacingGrip grip = PlacingGrip::kMove;
  std::size_t axis = 0;  // index in arrow_axes or turn_axes
  std::vector<glm::vec2> path_px;
};

// Change p' = scale turn (p - centre) + centre + move, all in world coordinates.
struct PlacingChange {
  glm::vec3 move_world{0};
  glm::quat turn{1, 0, 0, 0};
  float angle_rad = 0;  // angle of the turn about its axis, -2 pi to 2 pi
  float scale = 1;      // factor > 0
};

// The handles as the camera shows them; empty if the centre is not in front of the camera. Arrows that point
// at the camera are left out, because a drag of them would give no distance.
std::vector<PlacingHandle> handles_px(const PlacingHandles& handles, const Camera& camera);

// Index of the handle nearest to the pixel, at most within_px away; none: no handle is that near.
std::optional<std::size_t> handle_at(std::span<const PlacingHandle> shown, const glm::vec2& at_px,
                                     float within_px);

// The change that a drag of the handle from one pixel to another makes. in_steps: rounds turns to 15 degrees
// and scales to tenths, both counted with turned_deg and scaled.
PlacingChange dragged(const PlacingHandles& handles, const PlacingHandle& handle, const glm::vec2& from_px,
                      const glm::vec2& to_px, const Camera& camera, bool in_steps);

}  // namespace splatcut
