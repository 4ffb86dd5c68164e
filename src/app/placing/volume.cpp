#include "app/placing/volume.h"

#include <algorithm>
#include <cmath>

#include "app/placing/pointer_drag.h"

namespace splatcut {

namespace {

constexpr std::size_t kBoxHandles = 7;
constexpr float kLeastShare = 0.02f;  // of its size: no drag makes less of it

// Of the face that a handle of a box belongs to.
struct Face {
  int axis;
  float sign;
};
Face face_of(std::size_t handle) {
  return {static_cast<int>(handle - 1) / 2, handle % 2 == 1 ? 1.0f : -1.0f};
}

glm::vec3 outward(const Volume& volume, const Face& face) {
  glm::vec3 axis(0);
  axis[face.axis] = face.sign;
  return volume.world_from_box * axis;
}

glm::vec3 handle_world(const Volume& volume, std::size_t handle, const Camera& camera) {
  if (handle == 0) return volume.centre_world;
  if (volume.round)
    return volume.centre_world + volume.half.x * glm::transpose(camera.camera_from_world_rotation)[0];
  const Face face = face_of(handle);
  return volume.centre_world + volume.half[face.axis] * outward(volume, face);
}

bool in_front(const Camera& camera, const glm::vec3& point_world) {
  return camera.camera_from_world(point_world).z > 1e-6f;
}

}  // namespace

bool inside(const Volume& volume, const glm::vec3& point_world) {
  const glm::vec3 d = point_world - volume.centre_world;
  if (volume.round) return glm::dot(d, d) <= volume.half.x * volume.half.x;
  const glm::vec3 own = glm::abs(glm::conjugate(volume.world_from_box) * d);
  return own.x <= volume.half.x && own.y <= volume.half.y && own.z <= volume.half.z;
}

std::vector<glm::vec2> handles_px(const Volume& volume, const Camera& camera) {
  std::vector<glm::vec2> out;
  for (std::size_t handle = 0; handle < (volume.round ? 2 : kBoxHandles); ++handle) {
    const glm::vec3 at = handle_world(volume, handle, camera);
    if (!in_front(camera, at)) return {};
    out.push_back(pixel_of(camera, at));
  }
  return out;
}

Edges edges_px(const Volume& volume, const Camera& camera) {
  Edges out;
  const auto corner = [&](int bits) {
    const glm::vec3 own((bits & 1) ? volume.half.x : -volume.half.x,
                        (bits & 2) ? volume.half.y : -volume.half.y,
                        (bits & 4) ? volume.half.z : -volume.half.z);
    return volume.centre_world + volume.world_from_box * own;
  };
  for (int a = 0; a < 8; ++a)
    for (const int bit : {1, 2, 4}) {
      const glm::vec3 from = corner(a), to = corner(a | bit);
      if ((a & bit) == 0 && in_front(camera, from) && in_front(camera, to))
        out.emplace_back(pixel_of(camera, from), pixel_of(camera, to));
    }
  return out;
}

Volume dragged(const Volume& volume, std::size_t handle, const glm::vec2& from_px, const glm::vec2& to_px,
               const Camera& camera) {
  Volume out = volume;
  const glm::vec3 at = handle_world(volume, handle, camera);
  const float depth = camera.camera_from_world(at).z;
  if (handle == 0) {
    out.centre_world += way_at_depth(camera, depth, from_px, to_px);
    return out;
  }
  if (volume.round) {
    const float wanted = volume.half.x + (to_px.x - from_px.x) * depth / camera.fx_px;
    out.half = glm::vec3(std::max(kLeastShare * volume.half.x, wanted));
    return out;
  }
  const Face face = face_of(handle);
  const float least = kLeastShare * volume.half[face.axis];
  const float farther = way_along(camera, at, outward(volume, face), from_px, to_px);
  out.half[face.axis] = std::max(least, volume.half[face.axis] + 0.5f * farther);
  out.centre_world += (out.half[face.axis] - volume.half[face.axis]) * outward(volume, face);
  return out;
}

}  // namespace splatcut
