#include "scene/formats/spz_axes.h"

namespace splatcut {

namespace {

// How often the cameras of a capture have a Gaussian in their picture, over a sample of both.
std::size_t times_seen(const std::vector<glm::vec3>& positions, const std::vector<Camera>& cameras,
                       const AxisSigns& turned) {
  constexpr std::size_t kGaussians = 20000, kCameras = 60;
  std::size_t seen = 0;
  for (std::size_t c = 0; c < cameras.size(); c += 1 + cameras.size() / kCameras) {
    const Camera& camera = cameras[c];
    for (std::size_t g = 0; g < positions.size(); g += 1 + positions.size() / kGaussians) {
      const glm::vec3 p = camera.camera_from_world(turned.position(positions[g]));
      if (p.z <= 0) continue;
      const glm::vec2 pixel = camera.pixel_from_camera(p);
      seen += pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(camera.width_px) &&
              pixel.y < static_cast<float>(camera.height_px);
    }
  }
  return seen;
}

}  // namespace

std::optional<SpzAxes> axes_by_cameras(const GaussianCloud& cloud, const std::vector<Camera>& cameras) {
  constexpr double kClearly = 1.25;
  const auto rub = static_cast<double>(times_seen(cloud.position, cameras, {}));
  const auto ply = static_cast<double>(times_seen(cloud.position, cameras, kRightUpBack));
  if (ply > kClearly * rub) return SpzAxes::kPly;
  if (rub > kClearly * ply) return SpzAxes::kRub;
  return {};
}

}  // namespace splatcut
