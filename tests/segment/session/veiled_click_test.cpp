// A click through haze: the picture shows the thing behind it, and that is what is clicked.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scene/raster/rasterizer.h"
#include "segment/session/session.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

enum Layer : std::uint8_t { kWall, kBall, kHaze };

struct HazyScene {
  std::shared_ptr<GaussianCloud> cloud = std::make_shared<GaussianCloud>();
  std::vector<std::uint8_t> thing;
  std::size_t of(Layer which, const std::vector<std::uint8_t>& labels) const {
    std::size_t count = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) count += labels[g] && thing[g] == which;
    return count;
  }
};

constexpr std::size_t kWallRows = 4000, kBallRows = 1500;

// A red ball before a grey wall; nearer than both `layers` sheets of faint blue Gaussians as large as the
// ball.
HazyScene ball_behind_haze(int layers, float opacity) {
  constexpr std::size_t kAcross = 5;
  const std::size_t haze = static_cast<std::size_t>(layers) * kAcross * kAcross;
  HazyScene scene;
  GaussianCloud& cloud = *scene.cloud;
  cloud = random_cloud(kWallRows + kBallRows + haze, 5, 0, 0.05f);
  scene.thing.resize(cloud.size());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const glm::vec3 p = cloud.position[g];
    cloud.opacity[g] = 0.95f;
    const auto paint = [&](Layer thing, const glm::vec3& colour) {
      scene.thing[g] = thing;
      cloud.f_dc[g] = (colour - 0.5f) / 0.28209479177387814f + 0.05f * cloud.f_dc[g];
    };
    if (g < kWallRows) {
      cloud.position[g] = {2.5f * p.x, 2.5f * p.y, 1.2f + 0.02f * p.z};
      cloud.scale[g] = {0.07f, 0.07f, 0.07f};
      paint(kWall, {0.5f, 0.5f, 0.5f});
    } else if (g < kWallRows + kBallRows) {
      cloud.position[g] = 0.4f * glm::normalize(p);
      cloud.scale[g] = glm::vec3(0.03f);
      paint(kBall, {0.8f, 0.15f, 0.1f});
    } else {
      const std::size_t k = g - kWallRows - kBallRows, in_sheet = k % (kAcross * kAcross);
      const glm::vec2 at(static_cast<float>(in_sheet % kAcross) - 2,
                         static_cast<float>(in_sheet / kAcross) - 2);
      const float sheet = static_cast<float>(k / (kAcross * kAcross));
      cloud.position[g] = {0.5f * at.x, 0.5f * at.y, -1.2f + 0.1f * sheet};
      cloud.scale[g] = {0.4f, 0.4f, 0.02f};
      cloud.rotation[g] = glm::quat(1, 0, 0, 0);
      cloud.opacity[g] = opacity;
      paint(kHaze, {0.6f, 0.7f, 0.9f});
    }
  }
  return scene;
}

}  // namespace

TEST_CASE("veiled click: the thing that shows through haze is what a click takes") {
  // The haze makes 0, 20, 38 and 49 % of the clicked pixel, the ball less and less, but always the most.
  for (const auto& [layers, opacity] : {std::pair{0, 0.0f}, {1, 0.06f}, {1, 0.12f}, {3, 0.06f}}) {
    CAPTURE(layers);
    CAPTURE(opacity);
    const HazyScene scene = ball_behind_haze(layers, opacity);
    const Camera camera = front_camera(640, 480);
    const glm::vec2 middle(320, 240);
    const auto drawn_share = [&](Layer thing) {
      std::vector<std::uint8_t> labels(scene.thing.size());
      for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = scene.thing[g] == thing;
      return render_labels(*scene.cloud, camera, labels).at(320, 240);
    };
    CutRequest request;
    request.strokes = {{camera, {click(middle, SeedLabel::kObject)}}};
    Session session({.cloud = scene.cloud});
    const CutResult result = session.cut(request, CutSettings());
    CHECK(drawn_share(kHaze) < 0.5f);
    CHECK((drawn_share(kHaze) > 0.19f) == (layers > 0));
    REQUIRE(result.outcome == Outcome::kDone);
    CHECK(scene.of(kBall, result.labels) > 0.9 * kBallRows);
    CHECK(scene.of(kHaze, result.labels) <= (scene.thing.size() - kWallRows - kBallRows) / 10);
    CHECK(scene.of(kWall, result.labels) < 40);
  }
}
