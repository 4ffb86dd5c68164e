// Pinhole camera in the COLMAP convention: camera frame x right, y down, z forward; pixels x right,
// y down, pixel centres at +0.5.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <string>

namespace splatcut {

struct Camera {
  std::string name;  // img_name of the file it came from, or empty
  int width_px = 0, height_px = 0;
  float fx_px = 0, fy_px = 0;  // focal lengths
  float cx_px = 0, cy_px = 0;  // principal point
  glm::mat3 camera_from_world_rotation{1};
  glm::vec3 camera_from_world_translation{0};
  // Scene units: what the camera looks at is no nearer. The near plane of its pictures is that or the
  // cloud's.
  float most_near_plane = std::numeric_limits<float>::infinity();

  glm::vec3 camera_from_world(const glm::vec3& point_world) const {
    return camera_from_world_rotation * point_world + camera_from_world_translation;
  }
  glm::vec3 centre_world() const {
    return -(glm::transpose(camera_from_world_rotation) * camera_from_world_translation);
  }
  glm::vec3 forward_world() const { return glm::transpose(camera_from_world_rotation)[2]; }
  glm::vec3 down_world() const { return glm::transpose(camera_from_world_rotation)[1]; }
  // Pixel of a point in the camera frame; z must be > 0.
  glm::vec2 pixel_from_camera(const glm::vec3& point_camera) const {
    return {fx_px * point_camera.x / point_camera.z + cx_px, fy_px * point_camera.y / point_camera.z + cy_px};
  }
  // True if the point lies in the picture, whatever hides it.
  bool shows(const glm::vec3& point_world) const;
  // World point at depth z (scene units along the optical axis) behind the pixel.
  glm::vec3 world_from_pixel(const glm::vec2& pixel, float depth) const {
    const glm::vec3 point_camera{(pixel.x - cx_px) / fx_px * depth, (pixel.y - cy_px) / fy_px * depth, depth};
    return glm::transpose(camera_from_world_rotation) * (point_camera - camera_from_world_translation);
  }
};

bool same_camera(const Camera& a, const Camera& b);   // names and near planes apart
bool same_picture(const Camera& a, const Camera& b);  // names apart

// The same up to 1e-5 of what is compared: a view that is known again after it went through a file or was
// computed another way.
bool same_view(const Camera& a, const Camera& b);

// Place and direction alone, up to the same.
bool same_pose(const Camera& a, const Camera& b);

// A camera at `position` that sees `target` in the middle, `up` pointing up in the picture.
// fov_y_rad: vertical field of view, (0, pi). Throws Error where position equals target or up is parallel.
Camera look_at(const glm::vec3& position, const glm::vec3& target, const glm::vec3& up, float fov_y_rad,
               int width_px, int height_px);

// The same view with another picture size; what is visible vertically stays the same where the aspect
// ratio does.
Camera resized(const Camera& camera, int width_px, int height_px);

struct Margins {
  int left_px = 0, top_px = 0, right_px = 0, bottom_px = 0;
  bool any() const { return left_px + top_px + right_px + bottom_px > 0; }
};

// The same view with so many pixels more on each side, each at least 0.
Camera with_margins(const Camera& camera, const Margins& margins);

// resized() to the given width, height by the same aspect ratio, never larger than the camera itself.
Camera limited_to_width(const Camera& camera, int max_width_px);

}  // namespace splatcut
