// Where a user would click each object: a coarse label picture of every camera, from the splat centres of
// a subset, and in it the pixel of the object that is nearest to its middle and well inside it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/image.h"
#include "scene/still_life/still_life_model.h"

namespace splatcut::still_life {
namespace {

constexpr int kReduction = 4;                // label picture: 252 x 189
constexpr std::size_t kMostSplats = 150000;  // enough to close the surfaces at that size
constexpr int kLargestRadius = 4;            // of a splat in the label picture, pixels
constexpr float kFrontSigmas = 1.6f;         // radius of a splat's disc
constexpr float kSolid = 0.8f;               // fainter splats are haze, not surface
constexpr std::uint8_t kNothing = 255;

struct LabelPicture {
  Image<float> depth;
  Image<std::uint8_t> label;
};

void draw(LabelPicture& picture, const glm::vec2& centre, int radius, float depth, std::uint8_t label) {
  const int cx = static_cast<int>(std::floor(centre.x)), cy = static_cast<int>(std::floor(centre.y));
  for (int y = cy - radius; y <= cy + radius; ++y)
    for (int x = cx - radius; x <= cx + radius; ++x) {
      if (!picture.depth.contains(x, y) || depth >= picture.depth.at(x, y)) continue;
      if ((x - cx) * (x - cx) + (y - cy) * (y - cy) > radius * radius) continue;
      picture.depth.at(x, y) = depth;
      picture.label.at(x, y) = label;
    }
}

LabelPicture label_picture(const LabelledScene& scene, const Camera& camera) {
  const Camera small = resized(camera, camera.width_px / kReduction, camera.height_px / kReduction);
  LabelPicture picture{{small.width_px, small.height_px, std::numeric_limits<float>::infinity()},
                       {small.width_px, small.height_px, kNothing}};
  const GaussianCloud& cloud = scene.cloud;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kMostSplats);
  const float grow = kFrontSigmas * std::sqrt(static_cast<float>(step));  // each stands in for `step`
  for (std::size_t g = 0; g < cloud.size(); g += step) {
    const glm::vec3 p = small.camera_from_world(cloud.position[g]);
    if (p.z < 0.05f || cloud.opacity[g] < kSolid) continue;
    const float sigma = std::min(cloud.scale[g].x, cloud.scale[g].y);
    const int radius = std::min(kLargestRadius, static_cast<int>(small.fx_px * grow * sigma / p.z));
    draw(picture, small.pixel_from_camera(p), radius, p.z, scene.label[g]);
  }
  return picture;
}

struct Candidate {
  int area = 0;  // pixels of the object in the label picture
  glm::vec2 pixel{0};
};

// How much of the 5 x 5 pixels around belongs to the object: a click there does not slip off.
int support(const Image<std::uint8_t>& label, int x, int y, std::uint8_t object) {
  int count = 0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx)
      count += label.contains(x + dx, y + dy) && label.at(x + dx, y + dy) == object;
  return count;
}

Candidate candidate(const Image<std::uint8_t>& label, std::uint8_t object) {
  Candidate best;
  glm::vec2 sum{0};
  for (int y = 0; y < label.height(); ++y)
    for (int x = 0; x < label.width(); ++x)
      if (label.at(x, y) == object) sum += glm::vec2(x, y), ++best.area;
  if (best.area == 0) return best;
  const glm::vec2 middle = sum / static_cast<float>(best.area);
  const float size = std::sqrt(static_cast<float>(best.area));
  float best_score = -std::numeric_limits<float>::infinity();
  for (int y = 0; y < label.height(); ++y)
    for (int x = 0; x < label.width(); ++x) {
      if (label.at(x, y) != object) continue;
      const float inside = static_cast<float>(support(label, x, y, object)) / 25.0f;
      const float score = 2 * inside - glm::length(glm::vec2(x, y) - middle) / size;
      if (score <= best_score) continue;
      best_score = score;
      best.pixel = static_cast<float>(kReduction) * (glm::vec2(x, y) + 0.5f);
    }
  return best;
}

}  // namespace

std::vector<LabelledScene::SeedClick> seed_clicks(const LabelledScene& scene) {
  const std::size_t objects = scene.label_name.size();
  std::vector<std::vector<Candidate>> seen(objects);
  for (const Camera& camera : scene.cameras) {
    const LabelPicture picture = label_picture(scene, camera);
    for (std::size_t o = 1; o < objects; ++o)
      seen[o].push_back(candidate(picture.label, static_cast<std::uint8_t>(o)));
  }
  std::vector<LabelledScene::SeedClick> clicks;
  for (std::size_t o = 1; o < objects; ++o) {
    const auto smaller = [](const Candidate& a, const Candidate& b) { return a.area < b.area; };
    const auto largest = std::max_element(seen[o].begin(), seen[o].end(), smaller);
    if (largest == seen[o].end() || largest->area == 0) continue;
    // The first camera is the one on screen: good enough there beats best elsewhere.
    const auto chosen = 3 * seen[o].front().area >= largest->area ? seen[o].begin() : largest;
    clicks.push_back({scene.label_name[o], static_cast<int>(chosen - seen[o].begin()), chosen->pixel});
  }
  return clicks;
}

}  // namespace splatcut::still_life
