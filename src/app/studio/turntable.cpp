#include "app/studio/turntable.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/error.h"

namespace splatcut {

void check_turntable(const SaveTurntable& c) {
  constexpr int kMostFrames = 10000, kMostPixels = 8192;
  constexpr float kShortest = 0.1f, kLongest = 600;
  if (c.frames < 2 || c.frames > kMostFrames)
    throw Error("turntable", fmt::format("{} frames are too {}", c.frames, c.frames < 2 ? "few" : "many"));
  if (c.width_px < 0 || c.height_px < 0 || c.width_px > kMostPixels || c.height_px > kMostPixels)
    throw Error("turntable",
                fmt::format("a picture of {} x {} pixels is impossible", c.width_px, c.height_px));
  if (!(c.turn_s >= kShortest && c.turn_s <= kLongest))
    throw Error("turntable", fmt::format("a turn takes {} to {} seconds", kShortest, kLongest));
}

std::vector<Camera> cameras_of_turn(const ObjectExtent& extent, const Camera& front,
                                    const glm::vec3& up_world, const SaveTurntable& c) {
  const glm::vec3 back = front.centre_world() - extent.centre_world;
  const glm::vec3 offset = glm::normalize(back) * (extent.radius * 2 * OrbitOptions{}.distance_sizes);
  const float fov_y = 2 * std::atan(0.5f * static_cast<float>(front.height_px) / front.fy_px);
  const int width = c.width_px > 0 ? c.width_px : front.width_px;
  const int height = c.height_px > 0 ? c.height_px : front.height_px;
  std::vector<Camera> cameras;
  for (int i = 0; i < c.frames; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(c.frames);
    cameras.push_back(look_at(extent.centre_world + glm::angleAxis(angle, up_world) * offset,
                              extent.centre_world, up_world, fov_y, width, height));
  }
  return cameras;
}

}  // namespace splatcut
