// The object turning once, as pictures, animation or video.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/studio/studio.h"
#include "core/error.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

void check(const SaveTurntable& c) {
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

// Once round the object at the camera's own elevation, from where the user stands.
std::vector<Camera> cameras_of_turn(const ObjectExtent& extent, const Camera& front, const glm::vec3& up,
                                    const SaveTurntable& c) {
  const glm::vec3 back = front.centre_world() - extent.centre_world;
  const glm::vec3 offset = glm::normalize(back) * (extent.radius * 2 * OrbitOptions{}.distance_sizes);
  const float fov_y = 2 * std::atan(0.5f * static_cast<float>(front.height_px) / front.fy_px);
  const int width = c.width_px > 0 ? c.width_px : front.width_px;
  const int height = c.height_px > 0 ? c.height_px : front.height_px;
  std::vector<Camera> cameras;
  for (int i = 0; i < c.frames; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(c.frames);
    cameras.push_back(look_at(extent.centre_world + glm::angleAxis(angle, up) * offset, extent.centre_world,
                              up, fov_y, width, height));
  }
  return cameras;
}

}  // namespace

void Studio::perform(const SaveTurntable& c) {
  require_scene();
  check(c);
  const ObjectItem* object = document().active_object();
  if (!object || gaussians_of(object->id) == 0)
    throw Error("turntable", "there is no object to turn", "Click an object first");
  const std::vector<std::uint8_t> own = labels(object->id);
  const std::vector<Camera> cameras =
      cameras_of_turn(object_extent(*scene_->cloud, own), viewport_camera(), document().up_world, c);
  DrawLimits limits = draw_limits();
  limits.far_plane = DrawLimits{}.far_plane;  // that of another view
  const TurntableOptions options{c.as, c.path, c.turn_s, document().background};
  tasks_.submit(TaskKind::kExport, [this, c, cameras, visible = make_flags(own), limits, options,
                                    scene = scene_](const Job& job) {
    if (!save_turntable(*scene->cloud, cameras, visible, limits, options, job)) return;
    tasks_.post([this, c] {
      say(Message::Kind::kDone, fmt::format("{} frames saved to {}", c.frames, c.path.string()));
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

}  // namespace splatcut
