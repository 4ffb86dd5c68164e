#include "app/studio/free_sides.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/picture/hidden_share.h"
#include "scene/cloud/strays.h"

namespace splatcut {

namespace {

constexpr int kWidthPx = 160;  // of the pictures that are compared

}  // namespace

void FreeSides::frame_placed() {
  CameraController& camera = viewport_.camera();
  const std::vector<std::uint8_t> own = gaussians_of(*ws_.scene, viewport_.placed_file());
  const std::vector<glm::vec3> points = shown_points(*ws_.scene->cloud, own);
  if (points.empty()) return;
  camera.frame(camera.framing(points, viewport_.pane_camera(), camera.pose().camera_from_world));
}

void FreeSides::frame() {
  CameraController& camera = viewport_.camera();
  camera.finish_transition();
  const std::optional<Offer> offer = std::exchange(offer_, std::nullopt);
  if (viewport_.placing()) return frame_placed();
  const bool in_scene = ws_.view.display == DisplayMode::kWhole;  // alone, nothing stands before it
  if (offer && in_scene && offer->object == ws_.document().active && offer->from == camera.pose())
    return camera.frame(offer->side);
  const ObjectItem* object = ws_.document().active_object();
  std::vector<glm::vec3> points = viewport_.object_points();
  if (!object || points.empty()) return;
  const Camera pane = viewport_.pane_camera();
  const CameraController before = camera;  // frames from other sides, too, on the worker
  const CameraPose from = before.pose();
  std::vector<Framing> sides = {before.framing(points, pane, from.camera_from_world)};
  camera.frame(sides.front());
  if (!in_scene) return;
  const int height_px = std::max(1, kWidthPx * pane.height_px / std::max(1, pane.width_px));
  ws_.tasks.submit(TaskKind::kSides, [this, before, from, points = std::move(points), pane, sides, height_px,
                                      id = object->id, name = object->name, scene = ws_.scene,
                                      labels = ws_.labels.labels(ws_.document(), *object, ws_.gaussians())](
                                         const Job& job) mutable {
    constexpr float kApart = 0.25f;  // of the object's size
    const float apart = kApart * glm::length(robust_bounds(points).extent());
    constexpr double kMuch = 0.25, kBetter = 0.15, kAsGood = 0.03;
    constexpr double kSeen = 0.5, kOutOfSight = 0.9;
    const auto hides = [&](const CameraPose& pose) {
      return hidden_share(*scene, *labels, camera_at(pose, kWidthPx, height_px), apart, job);
    };
    std::vector<double> hidden = {hides(sides.front().pose)};
    if (job.cancelled() || hidden.front() < kMuch) return;
    for (const glm::quat& rotation : before.directions_around()) {
      sides.push_back(before.framing(points, pane, rotation));
      hidden.push_back(hides(sides.back().pose));
      if (job.cancelled()) return;
    }
    const double least = std::ranges::min(hidden);
    if (least > hidden.front() - kBetter) return;
    const auto best = static_cast<std::size_t>(  // the nearest of those as good
        std::ranges::find_if(hidden, [&](double h) { return h <= least + kAsGood; }) - hidden.begin());
    // The way back led behind a wall, as to see all of a floor.
    const bool lost = hidden.front() > kOutOfSight && hides(from) < kSeen;
    ws_.tasks.post([this, scene, name, lost, offered = Offer{id, sides.front().pose, sides[best]}] {
      if (scene != ws_.scene || offered.object != ws_.document().active) return;
      if (lost && viewport_.camera().goal() == offered.from) {
        viewport_.camera().frame(offered.side);
        return ws_.say(Message::Kind::kInfo,
                       fmt::format("Something stands before {}: shown from a side where less does", name));
      }
      offer_ = offered;
      ws_.say(Message::Kind::kInfo,
              fmt::format("Something stands before {}: F again looks from a side where less does", name));
    });
  });
}

}  // namespace splatcut
