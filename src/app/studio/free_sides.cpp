#include "app/studio/free_sides.h"

#include <fmt/format.h>

#include <numeric>

#include "scene/cloud/strays.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

constexpr int kWidthPx = 160;  // of the pictures that are compared

double sum(const Image<float>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

// The share of the object's picture that others hide who stand `apart` or more before it. What it is set
// into, and the blurred splats around it, do not.
double hidden_share(const OpenedScene& scene, const std::vector<std::uint8_t>& labels, const Camera& camera,
                    float apart, const Job& job) {
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  options.labels = labels;
  options.blocks = scene.blocks.get();
  const RasterOutput seen = rasterize(*scene.cloud, camera, options, job);
  options.shown = labels;
  const RasterOutput alone = rasterize(*scene.cloud, camera, options, job);
  if (job.cancelled()) return 0;
  double hidden = 0;
  for (std::size_t i = 0; i < alone.label_share.pixels().size(); ++i) {
    const float z = seen.median_depth.pixels()[i];  // 0: nothing there is opaque
    if (z > 0 && z < alone.median_depth.pixels()[i] - apart)
      hidden += alone.label_share.pixels()[i] - seen.label_share.pixels()[i];
  }
  const double all = sum(alone.label_share);
  return all > 0 ? hidden / all : 0;
}

}  // namespace

void FreeSides::frame_placed() {
  CameraController& camera = viewport_.camera();
  const std::vector<std::uint8_t> own = gaussians_of(*ws_.scene, viewport_.placed_file());
  std::vector<glm::vec3> positions;
  for (std::size_t g = 0; g < own.size(); ++g)
    if (own[g]) positions.push_back(ws_.scene->cloud->position[g]);
  positions = without_strays(positions);
  if (positions.empty()) return;
  camera.frame(camera.framing(positions, viewport_.pane_camera(), viewport_.kept_bottom_px(),
                              camera.pose().camera_from_world));
}

void FreeSides::frame() {
  CameraController& camera = viewport_.camera();
  camera.finish_transition();
  const std::optional<Offer> offer = std::exchange(offer_, std::nullopt);
  if (viewport_.placing()) return frame_placed();
  if (offer && offer->from == camera.pose()) return camera.frame(offer->side);
  const ObjectItem* object = ws_.document().active_object();
  const std::vector<glm::vec3> positions = without_strays(viewport_.object_positions());
  if (!object || positions.empty()) return;
  const Camera pane = viewport_.pane_camera();
  const auto framed = [&](const glm::quat& rotation) {
    return camera.framing(positions, pane, viewport_.kept_bottom_px(), rotation);
  };
  std::vector<Framing> sides = {framed(camera.pose().camera_from_world)};
  for (const glm::quat& rotation : camera.directions_around()) sides.push_back(framed(rotation));
  camera.frame(sides.front());
  if (ws_.view.display != DisplayMode::kWhole) return;
  constexpr float kApart = 0.25f;  // of the object's size
  const float apart = kApart * glm::length(robust_bounds(positions).extent());
  const int height_px = std::max(1, kWidthPx * pane.height_px / std::max(1, pane.width_px));
  ws_.tasks.submit(TaskKind::kSides, [this, sides, height_px, apart, name = object->name, scene = ws_.scene,
                                      labels = ws_.labels.labels(ws_.document(), *object, ws_.gaussians())](
                                         const Job& job) {
    constexpr double kMuch = 0.25, kBetter = 0.15, kAsGood = 0.03;
    std::vector<double> hidden;
    for (const Framing& side : sides) {
      hidden.push_back(hidden_share(*scene, *labels, camera_at(side.pose, kWidthPx, height_px), apart, job));
      if (job.cancelled() || hidden.front() < kMuch) return;
    }
    const double least = std::ranges::min(hidden);
    if (least > hidden.front() - kBetter) return;
    const auto best = static_cast<std::size_t>(  // the nearest of those as good
        std::ranges::find_if(hidden, [&](double h) { return h <= least + kAsGood; }) - hidden.begin());
    ws_.tasks.post([this, scene, name, offered = Offer{sides.front().pose, sides[best]}] {
      if (scene != ws_.scene) return;
      offer_ = offered;
      ws_.say(Message::Kind::kInfo,
              fmt::format("Something stands before {}: F again looks from a side where less does", name));
    });
  });
}

}  // namespace splatcut
