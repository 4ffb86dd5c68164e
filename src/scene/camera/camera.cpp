#include "scene/camera/camera.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace splatcut {

bool same_camera(const Camera& a, const Camera& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px && a.fy_px == b.fy_px &&
         a.cx_px == b.cx_px && a.cy_px == b.cy_px &&
         a.camera_from_world_rotation == b.camera_from_world_rotation &&
         a.camera_from_world_translation == b.camera_from_world_translation;
}

bool same_picture(const Camera& a, const Camera& b) {
  return same_camera(a, b) && a.most_near_plane == b.most_near_plane;
}

namespace {

constexpr float kSame = 1e-5f;

bool near(float x, float y, float size) {
  return std::abs(x - y) <= kSame * size;
}

}  // namespace

bool same_view(const Camera& a, const Camera& b) {
  const auto width = static_cast<float>(a.width_px), height = static_cast<float>(a.height_px);
  if (a.width_px != b.width_px || a.height_px != b.height_px || !near(a.fx_px, b.fx_px, std::abs(a.fx_px)) ||
      !near(a.fy_px, b.fy_px, std::abs(a.fy_px)) || !near(a.cx_px, b.cx_px, width) ||
      !near(a.cy_px, b.cy_px, height))
    return false;
  return same_pose(a, b);
}

bool same_pose(const Camera& a, const Camera& b) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!near(a.camera_from_world_rotation[column][row], b.camera_from_world_rotation[column][row], 1))
        return false;
  const glm::vec3 &s = a.camera_from_world_translation, &t = b.camera_from_world_translation;
  return glm::distance(s, t) <= kSame * std::max(glm::length(s), glm::length(t));
}

Camera look_at(const glm::vec3& position, const glm::vec3& target, const glm::vec3& up, float fov_y_rad,
               int width_px, int height_px) {
  const glm::vec3 forward = target - position;
  if (!(glm::length(forward) > 0)) throw Error("camera", "position and target are the same point");
  if (!std::isfinite(glm::length(forward)))
    throw Error("camera", "position and target are too far apart: their distance is no number",
                "Give nearer ones");
  const glm::vec3 z = glm::normalize(forward);
  const glm::vec3 right = glm::cross(z, up);
  if (!(glm::length(right) > 1e-6f * glm::length(up)))
    throw Error("camera", "the up direction is zero or parallel to the view direction",
                "Give another --camera-up");
  const glm::vec3 x = glm::normalize(right);
  const glm::vec3 y = glm::cross(z, x);
  Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fy_px = 0.5f * static_cast<float>(height_px) / std::tan(0.5f * fov_y_rad);
  camera.fx_px = camera.fy_px;
  camera.cx_px = 0.5f * static_cast<float>(width_px);
  camera.cy_px = 0.5f * static_cast<float>(height_px);
  camera.camera_from_world_rotation = glm::transpose(glm::mat3(x, y, z));
  camera.camera_from_world_translation = -(camera.camera_from_world_rotation * position);
  return camera;
}

Camera resized(const Camera& camera, int width_px, int height_px) {
  Camera out = camera;
  const float sx = static_cast<float>(width_px) / static_cast<float>(camera.width_px);
  const float sy = static_cast<float>(height_px) / static_cast<float>(camera.height_px);
  const bool same_aspect =
      std::abs(static_cast<float>(camera.width_px) * sy - static_cast<float>(width_px)) <= 1.0f;
  out.width_px = width_px;
  out.height_px = height_px;
  out.fy_px = camera.fy_px * sy;
  out.fx_px = camera.fx_px * (same_aspect ? sx : sy);  // another aspect shows more or less, never stretches
  out.cy_px = camera.cy_px * sy;
  out.cx_px = same_aspect ? camera.cx_px * sx
                          : 0.5f * static_cast<float>(width_px) +
                                (camera.cx_px - 0.5f * static_cast<float>(camera.width_px)) * sy;
  return out;
}

bool Camera::shows(const glm::vec3& point_world) const {
  const glm::vec3 at = camera_from_world(point_world);
  if (!(at.z > 0)) return false;
  const glm::vec2 pixel = pixel_from_camera(at);
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(width_px) &&
         pixel.y < static_cast<float>(height_px);
}

Camera with_margins(const Camera& camera, const Margins& margins) {
  Camera out = camera;
  out.width_px += margins.left_px + margins.right_px;
  out.height_px += margins.top_px + margins.bottom_px;
  out.cx_px += static_cast<float>(margins.left_px);
  out.cy_px += static_cast<float>(margins.top_px);
  return out;
}

Camera limited_to_width(const Camera& camera, int max_width_px) {
  if (camera.width_px <= max_width_px) return camera;
  const double s = static_cast<double>(max_width_px) / camera.width_px;
  return resized(camera, max_width_px, std::max(1, static_cast<int>(std::lround(camera.height_px * s))));
}

}  // namespace splatcut
