#include "app/picture/picture_depth.h"

namespace splatcut {

PictureDepth::PictureDepth(const FrameResult* picture, std::size_t pane) {
  if (picture && pane < picture->frames.size()) frame_ = picture->frames[pane].get();
}

std::optional<glm::vec3> PictureDepth::before(const glm::vec3& point_world, float slack) const {
  if (!frame_) return {};
  const Camera& camera = frame_->camera;
  const glm::vec3 point_camera = camera.camera_from_world(point_world);
  if (!(point_camera.z > 0)) return {};
  const glm::vec2 pixel = glm::floor(camera.pixel_from_camera(point_camera));
  const Image<float>& depth = frame_->depth;
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(depth.width()) &&
        pixel.y < static_cast<float>(depth.height())))
    return {};
  const float surface_z = depth.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
  if (!(surface_z > 0) || surface_z + slack >= point_camera.z) return {};
  return camera.world_from_pixel(camera.pixel_from_camera(point_camera), surface_z);
}

}  // namespace splatcut
