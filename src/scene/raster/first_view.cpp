#include "scene/raster/first_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "core/ranks.h"
#include "scene/cloud/captured_detail.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

// What was captured most finely.
struct Subject {
  glm::vec3 centre{0};        // of its box, to aim at
  float radius = 0;           // within it of the detail's median lies half of the detail
  CapturedDetail detail;      // around it
  bool stands_alone = false;  // a tall thing, hardly anything else: is to be seen from head to foot
};

bool higher_than_wide(const CapturedDetail& detail, const glm::vec3& up) {
  const glm::vec3 size = robust_bounds(detail.position_world, 0.96).extent();
  const glm::vec3 width = size * (1.0f - glm::abs(up));
  return glm::length(size * glm::abs(up)) > std::max({width.x, width.y, width.z});
}

Subject subject_of(const GaussianCloud& cloud, const glm::vec3& up) {
  const CapturedDetail all = captured_detail(cloud);
  const Ball middle = middle_half(all);
  Subject subject;
  subject.centre = middle.centre_world;
  subject.radius = middle.radius;
  const auto within = [&](float most) {
    CapturedDetail detail;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (glm::distance(all.position_world[i], middle.centre_world) < most)
        detail.add(all.position_world[i], all.weight[i]);
    return detail;
  };
  const CapturedDetail around = within(3 * subject.radius);
  if (around.size() == 0) return subject;
  constexpr double kHardlyElse = 0.97;
  subject.stands_alone = around.total() > kHardlyElse * all.total() && higher_than_wide(around, up);
  subject.detail = subject.stands_alone ? around : within(2.5f * subject.radius);
  if (subject.stands_alone) std::ranges::fill(subject.detail.weight, 1.0);
  subject.centre = robust_bounds(subject.detail.position_world, 0.96).centre();
  return subject;
}

// Shapes alone, of a large cloud every so manieth, and larger, so that surfaces stay closed.
struct Shapes {
  GaussianCloud cloud;
  float larger = 1;
};

Shapes shapes_of(const GaussianCloud& cloud) {
  constexpr std::size_t kEnough = 1 << 18;
  const std::size_t step = std::max<std::size_t>(1, (cloud.size() + kEnough - 1) / kEnough);
  Shapes shapes;
  shapes.larger = std::sqrt(static_cast<float>(step));
  shapes.cloud.resize((cloud.size() + step - 1) / step, 0);
  shapes.cloud.near_plane = cloud.near_plane;
  for (std::size_t to = 0, from = 0; from < cloud.size(); ++to, from += step) {
    shapes.cloud.position[to] = cloud.position[from];
    shapes.cloud.scale[to] = shapes.larger * cloud.scale[from];
    shapes.cloud.rotation[to] = cloud.rotation[from];
    shapes.cloud.opacity[to] = cloud.opacity[from];
  }
  return shapes;
}

// What a picture 160 px wide shows.
struct Shown {
  double sharpness = 0;  // [0, 1]; blurs, black and what stands before the lens take from it
  double framed = 0;     // share of the subject that lies well inside the picture
  double seen = 0;       // of that, the share that nothing hides
  float median_depth = 0;
};

double sharpness(const Shapes& shapes, const Camera& camera, const RasterOutput& picture, float near_depth) {
  const float sharp_px = 1.5f * shapes.larger;
  double sharp = 0, covered = 0, near = 0;
  for (std::size_t i = 0; i < picture.first_hit.size(); ++i) {
    const std::int32_t g = picture.first_hit.pixels()[i];
    if (g < 0) continue;
    const float depth = picture.median_depth.pixels()[i];
    const float px =
        middle_sigma(shapes.cloud.scale[static_cast<std::size_t>(g)]) * camera.fx_px / depth / sharp_px;
    sharp += 1 / (1 + px * px);
    near += depth < near_depth;
    ++covered;
  }
  if (covered == 0) return 0;
  const auto pixels = static_cast<double>(picture.first_hit.size());
  const double clear = 1 - near / pixels;
  return sharp / pixels * std::pow(sharp / covered * clear, 2);
}

float median_depth(const RasterOutput& picture) {
  std::vector<float> depths;
  for (const float depth : picture.median_depth.pixels())
    if (depth > 0) depths.push_back(depth);
  return median(std::move(depths));
}

Shown shown(const Shapes& shapes, const Subject& subject, const Camera& view, float near_depth,
            const Job& job) {
  constexpr float kInner = 0.42f;  // of the picture's sides, from the middle
  constexpr float kBehind = 1.1f;  // times the picture's depth: hidden
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  const Camera camera = limited_to_width(view, 160);
  const RasterOutput picture = rasterize(shapes.cloud, camera, options, job);
  Shown result;
  if (job.cancelled()) return result;
  const double all = subject.detail.total();
  double framed = 0, seen = 0;
  for (std::size_t i = 0; i < subject.detail.size(); ++i) {
    const glm::vec3 p = camera.camera_from_world(subject.detail.position_world[i]);
    if (p.z <= 0) continue;
    const glm::vec2 at = camera.pixel_from_camera(p);
    const glm::vec2 off = glm::abs(at / glm::vec2(camera.width_px, camera.height_px) - 0.5f);
    if (!(std::max(off.x, off.y) <= kInner)) continue;
    framed += subject.detail.weight[i];
    const float depth = picture.median_depth.at(static_cast<int>(at.x), static_cast<int>(at.y));
    if (depth == 0 || p.z <= kBehind * depth) seen += subject.detail.weight[i];
  }
  result.median_depth = median_depth(picture);
  result.sharpness = sharpness(shapes, camera, picture, near_depth);
  if (all > 0) result.framed = framed / all;
  if (framed > 0) result.seen = seen / framed;
  return result;
}

// Offers views, and keeps the best.
class Search {
 public:
  Search(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world, const Camera& outside,
         const Job& job)
      : subject_(subject_of(cloud, glm::normalize(up_world))),
        shapes_(shapes_of(cloud)),
        bounds_(bounds),
        size_(glm::length(bounds.extent())),
        up_(glm::normalize(up_world)),
        outside_(outside),
        job_(job) {
    const glm::vec3 arm = outside.centre_world() - bounds.centre();
    level_ = glm::normalize(arm - glm::dot(arm, up_) * up_);
  }

  std::optional<Camera> best() {
    constexpr float kSpread = 0.1f;  // of the scene's size: below, one thing was captured
    const Shown all = shown(shapes_, subject_, outside_, 0, job_);
    best_score_ = kOutside * all.sharpness;
    if (subject_.radius > 0) look_at_subject();
    if (!subject_.stands_alone && subject_.radius >= kSpread * size_) look_from_within();
    return best_;
  }

 private:
  static constexpr double kOutside = 0.5, kWithin = 0.78;  // what a view from there counts
  static constexpr int kDirections = 8;

  glm::vec3 direction(int i) const {
    return glm::angleAxis(glm::two_pi<float>() * static_cast<float>(i) / kDirections, up_) * level_;
  }

  Shown shown_from(const glm::vec3& eye, const glm::vec3& target, float near_depth, Camera* view) const {
    const float fov_y = 2 * std::atan(0.5f * static_cast<float>(outside_.height_px) / outside_.fy_px);
    *view = look_at(eye, target, up_, fov_y, outside_.width_px, outside_.height_px);
    return job_.cancelled() ? Shown{} : shown(shapes_, subject_, *view, near_depth, job_);
  }

  double offer(const Camera& view, double score) {
    if (score > best_score_) best_score_ = score, best_ = view;
    return score;
  }

  double look_at_subject(int side, float radii, float elevation_rad) {
    constexpr float kNearShare = 0.35f;  // of the way: nearer stands before the lens
    constexpr double kSeen = 0.5;        // more of a thing is never seen from one side
    const float distance = radii * subject_.radius;
    const glm::vec3 from = std::cos(elevation_rad) * direction(side) + std::sin(elevation_rad) * up_;
    Camera view;
    const Shown s =
        shown_from(subject_.centre + distance * from, subject_.centre, kNearShare * distance, &view);
    const double least = subject_.stands_alone ? 0.8 : 0.6;
    const double framing = std::clamp((s.framed - least) / (1 - least), 0.05, 1.0);
    return offer(view, framing * framing * std::min(1.0, s.seen / kSeen) * s.sharpness);
  }

  void look_at_subject() {
    constexpr std::size_t kBestSides = 3;
    std::array<std::pair<double, int>, kDirections> sides;
    for (int i = 0; i < kDirections; ++i)
      sides[static_cast<std::size_t>(i)] = {-look_at_subject(i, 4.5f, 0.35f), i};
    std::ranges::sort(sides);
    for (std::size_t s = 0; s < kBestSides; ++s)
      for (const float radii : {3.5f, 4.5f, 7.0f})
        for (const float elevation_rad : {0.15f, 0.5f})
          look_at_subject(sides[s].second, radii, elevation_rad);
  }

  void look_around(const glm::vec3& centre, float back) {
    constexpr float kDown = 0.2f;  // what stands on the floor
    // Of the scene's size: nearer stands before the lens; as far as that should be what is seen.
    constexpr float kNearShare = 0.03f, kWideShare = 0.08f;
    for (int i = 0; i < kDirections; ++i) {
      const glm::vec3 along = -direction(i) - kDown * up_, eye = centre - back * size_ * along;
      Camera view;
      const Shown s = shown_from(eye, eye + size_ * along, kNearShare * size_, &view);
      offer(view, kWithin * std::min(1.0f, s.median_depth / (kWideShare * size_)) * s.sharpness);
    }
  }

  void look_from_within() {
    for (const glm::vec3& centre : {bounds_.centre(), subject_.centre})
      for (const float back : {0.0f, 0.15f}) look_around(centre, back);
    for (int i = 0; i < kDirections; i += 2)  // the middle may lie in a wall
      look_around(bounds_.centre() + 0.5f * subject_.radius * direction(i), 0);
  }

  const Subject subject_;
  const Shapes shapes_;
  const Box& bounds_;
  const float size_;
  const glm::vec3 up_;
  const Camera& outside_;
  const Job& job_;
  glm::vec3 level_;  // from the middle to `outside`, level
  std::optional<Camera> best_;
  double best_score_ = 0;
};

}  // namespace

Camera view_of_all(const Box& bounds, const glm::vec3& up_world, float fov_y_rad, int width_px,
                   int height_px) {
  constexpr float kFramesPerRadius = 1.15f;
  constexpr float kDown = 0.35f;
  const glm::vec3 up = glm::normalize(up_world),
                  ahead = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 forward = glm::normalize(ahead - glm::dot(ahead, up) * up - kDown * up);
  const float size = glm::length(bounds.extent()), radius = size > 0 ? 0.5f * size : 1.0f;
  return look_at(bounds.centre() - kFramesPerRadius * radius / std::sin(0.5f * fov_y_rad) * forward,
                 bounds.centre(), up, fov_y_rad, width_px, height_px);
}

std::optional<Camera> better_first_view(const GaussianCloud& cloud, const Box& bounds,
                                        const glm::vec3& up_world, const Camera& outside, const Job& job) {
  if (!(glm::length(bounds.extent()) > 0)) return {};  // all in one point
  return Search(cloud, bounds, up_world, outside, job).best();
}

}  // namespace splatcut
