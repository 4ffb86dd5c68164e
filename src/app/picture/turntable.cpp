#include "app/picture/turntable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/error.h"

namespace splatcut {

void check_turntable(const SaveTurntable& c) {
  constexpr int kMostFrames = 10000, kMostPixels = 8192;
  constexpr float kShortest = 0.1f, kLongest = 600;
  if (c.frames < 2 || c.frames > kMostFrames)
    throw Error("", fmt::format("{} pictures are too {}", c.frames, c.frames < 2 ? "few" : "many"));
  if (c.width_px < 0 || c.height_px < 0 || c.width_px > kMostPixels || c.height_px > kMostPixels)
    throw Error("", fmt::format("A picture of {} x {} pixels is impossible", c.width_px, c.height_px));
  if (!(c.turn_s >= kShortest && c.turn_s <= kLongest))
    throw Error("", fmt::format("A turn takes {} to {} seconds", kShortest, kLongest));
}

std::vector<Camera> cameras_of_turn(const ObjectExtent& extent, const Camera& front,
                                    const glm::vec3& up_world, const SaveTurntable& c) {
  const glm::vec3 back = front.centre_world() - extent.centre_world;
  const float half_y = std::atan(0.5f * static_cast<float>(front.height_px) / front.fy_px),
              fov_y = 2 * half_y;
  const int width = c.width_px > 0 ? c.width_px : front.width_px;
  const int height = c.height_px > 0 ? c.height_px : front.height_px;
  // The sphere around the object fits into the smaller side, however wide the view is.
  constexpr float kMargin = 1.08f;  // Gaussians reach beyond their centres
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const float half = std::min(half_y, std::atan(aspect * std::tan(half_y)));
  const glm::vec3 offset = glm::normalize(back) * (kMargin * extent.radius / std::sin(half));
  std::vector<Camera> cameras;
  for (int i = 0; i < c.frames; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(c.frames);
    cameras.push_back(look_at(extent.centre_world + glm::angleAxis(angle, up_world) * offset,
                              extent.centre_world, up_world, fov_y, width, height));
  }
  return cameras;
}

}  // namespace splatcut
