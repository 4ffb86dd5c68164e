#include "segment/finish/seen_from.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/finish/shown_part.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kWidthPx = 160;
constexpr float kVisible = 0.4f;

// Level, of what one looks along; zero where that is straight up or down, or nowhere.
glm::vec3 level_part(const glm::vec3& towards, const glm::vec3& up) {
  const glm::vec3 level = towards - glm::dot(towards, up) * up;
  return glm::length(level) < 1e-6f ? glm::vec3(0) : level;
}

std::array<glm::vec3, 6> side_directions(const glm::vec3& up_world, const glm::vec3& towards) {
  const glm::vec3 up = glm::normalize(up_world);
  glm::vec3 front = level_part(towards, up);
  if (front == glm::vec3(0)) front = std::abs(up.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  front = glm::normalize(front - glm::dot(front, up) * up);
  const glm::vec3 right = glm::cross(up, front);
  return {front, right, -front, -right, up, -up};
}

// The share of the object's picture alone that the scene leaves visible; 0 where it is not in the picture.
float visible_share(const Drawer& scene, const GaussianCloud& object, std::span<const std::uint8_t> labels,
                    const Camera& camera, const Job& job) {
  RasterOptions raster;
  raster.colour = false;
  raster.roi = labelled_rectangle(scene.cloud(), camera, labels);
  if (raster.roi->empty()) return 0;
  const Image<float> alone = rasterize(object, camera, raster, job).alpha;
  raster.labels = labels;
  const Image<float> within = scene.draw(camera, raster, job).label_share;
  if (job.cancelled()) return 0;
  std::size_t all = 0, visible = 0;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    if (alone.pixels()[i] < kVisible) continue;
    ++all;
    visible += within.pixels()[i] >= kVisible;
  }
  return all == 0 ? 0 : static_cast<float>(visible) / static_cast<float>(all);
}

// The cameras of the capture nearest to a side, as seen from the object, that have it in their picture.
std::vector<Camera> cameras_at(const glm::vec3& side, const ObjectExtent& object,
                               std::span<const Camera> cameras) {
  constexpr float kLeastCosine = 0.5f;  // 60 degrees
  constexpr std::size_t kMost = 3;
  std::vector<std::pair<float, const Camera*>> near;
  for (const Camera& camera : cameras) {
    const glm::vec3 away = camera.centre_world() - object.centre_world;
    const float cosine = glm::dot(away, side) / std::max(glm::length(away), 1e-12f);
    if (cosine >= kLeastCosine && camera.shows(object.centre_world)) near.emplace_back(-cosine, &camera);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Camera> chosen;
  for (std::size_t i = 0; i < std::min(kMost, near.size()); ++i)
    chosen.push_back(limited_to_width(*near[i].second, kWidthPx));
  return chosen;
}

// What each Gaussian is worth in a rectangle of the view, px.
PlaneSums worth(const Drawer& cloud, const Camera& camera, const PixelRect& rect, const Job& job) {
  PlaneSums sums(cloud.cloud().size(), 1);
  add_shown_px(cloud, camera, rect, {}, &sums, job);
  return sums;
}

void add_views(const Drawer& scene, std::span<const std::uint32_t> object, const GaussianCloud& alone,
               std::span<const std::uint8_t> labels, std::span<const Camera> cameras, const glm::vec3& centre,
               SeenFrom* seen, const Job& job) {
  constexpr double kLeastShare = 0.25;
  seen->by_views.assign(object.size(), 0);
  for (std::size_t v = 0; v < cameras.size() && !job.cancelled(); ++v) {
    job.progress("who saw it", static_cast<double>(v) / static_cast<double>(cameras.size()));
    seen->views.push_back(glm::normalize(cameras[v].centre_world() - centre));
    const PixelRect rect = labelled_rectangle(scene.cloud(), cameras[v], labels);
    if (rect.empty()) continue;
    const PlaneSums within = worth(scene, cameras[v], rect, job), all = worth(alone, cameras[v], rect, job);
    for (std::size_t i = 0; i < object.size(); ++i)
      if (all.at(i, 0) > 0 && within.at(object[i], 0) >= kLeastShare * all.at(i, 0))
        seen->by_views[i] |= std::uint32_t{1} << v;
  }
}

std::vector<glm::vec3> colours_from(const SeenFrom& seen, const glm::vec3& side) {
  constexpr glm::vec3 kNever{0.9f, 0.1f, 0.1f}, kSome{0.95f, 0.85f, 0.2f}, kAll{0.2f, 0.45f, 0.95f};
  constexpr float kLeastCosine = 0.2f;
  std::uint32_t from_there = 0;
  for (std::size_t v = 0; v < seen.views.size(); ++v)
    if (glm::dot(seen.views[v], side) > kLeastCosine) from_there |= std::uint32_t{1} << v;
  std::vector<glm::vec3> colours;
  for (const std::uint32_t by : seen.by_views) {
    const int count = std::popcount(by & from_there), all = std::popcount(from_there);
    colours.push_back(
        count == 0 ? kNever : glm::mix(kSome, kAll, static_cast<float>(count) / static_cast<float>(all)));
  }
  return colours;
}

}  // namespace

std::vector<std::string> SeenFrom::never() const {
  std::vector<std::string> names;
  for (std::size_t s = has_front ? 0 : kLevelSides; s < side_share.size(); ++s)
    if (side_share.at(s) < kLeastSeenShare) names.emplace_back(kSideNames.at(s));
  return names;
}

float SeenFrom::unseen_share() const {
  float seen = 0;
  for (const float share : side_share) seen += share >= kEnoughSeenShare ? 1 : share;
  return 1 - seen / static_cast<float>(side_share.size());
}

SeenSides::SeenSides(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                     const glm::vec3& towards, std::span<const Camera> cameras)
    : scene_(scene),
      labels_(labels),
      up_(glm::normalize(up_world)),
      front_(side_directions(up_world, towards)[0]),
      cameras_(cameras),
      alone_(permuted(scene.cloud(), labelled_rows(labels))),
      extent_(object_extent(scene.cloud(), labels)) {}

Camera SeenSides::looking_from(const glm::vec3& direction) const {
  constexpr float kDistance = 3.2f, kFovYDeg = 40;  // radii
  const glm::vec3 level = std::abs(glm::dot(direction, up_)) > 0.99f ? front_ : up_;
  return with_room(look_at(extent_.centre_world + kDistance * extent_.radius * glm::normalize(direction),
                           extent_.centre_world, level, glm::radians(kFovYDeg), kWidthPx, kWidthPx),
                   extent_);
}

float SeenSides::share(const glm::vec3& side, float enough, const Job& job) const {
  std::vector<Camera> looking = cameras_at(side, extent_, cameras_);
  if (cameras_.empty()) {
    const glm::vec3 first = std::abs(glm::dot(side, up_)) > 0.5f ? front_ : up_,
                    second = glm::cross(side, first);
    constexpr float kAside = 0.6f;
    looking.push_back(looking_from(side));
    for (const glm::vec3& aside : {first, second, -second})
      looking.push_back(looking_from(side + kAside * aside));
  }
  float share = 0;
  for (const Camera& camera : looking)
    if (share < enough) share = std::max(share, visible_share(scene_, alone_, labels_, camera, job));
  return share;
}

SeenFrom seen_by_views(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                       std::span<const Camera> cameras, const Job& job) {
  const std::vector<std::uint32_t> object = labelled_rows(labels);
  SeenFrom seen;
  add_views(scene, object, permuted(scene.cloud(), object), labels,
            own_cameras(scene.cloud(), labels, up_world, cameras, {}),
            object_extent(scene.cloud(), labels).centre_world, &seen, job);
  return seen;
}

SeenFrom seen_sides(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                    const glm::vec3& from_world, std::span<const Camera> cameras, const Job& job) {
  const glm::vec3 towards = from_world - object_extent(scene.cloud(), labels).centre_world;
  SeenFrom seen;
  seen.sides = side_directions(up_world, towards);
  seen.has_front = level_part(towards, glm::normalize(up_world)) != glm::vec3(0);
  const SeenSides sides(scene, labels, up_world, towards, cameras);
  for (std::size_t s = 0; s < seen.sides.size() && !job.cancelled(); ++s) {
    seen.side_cameras.at(s) = sides.looking_from(seen.sides.at(s));
    seen.side_share.at(s) = sides.share(seen.sides.at(s), kEnoughSeenShare, job);
  }
  return seen;
}

SeenFrom seen_from(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                   const glm::vec3& from_world, std::span<const Camera> cameras, const Job& job) {
  SeenFrom seen = seen_sides(scene, labels, up_world, from_world, cameras, job);
  SeenFrom views = seen_by_views(scene, labels, up_world, cameras, job);
  seen.views = std::move(views.views);
  seen.by_views = std::move(views.by_views);
  return seen;
}

Image<Rgb8> seen_picture(const SeenFrom& seen, const Drawer& scene, std::span<const std::uint8_t> labels,
                         const Job& job) {
  const GaussianCloud alone = permuted(scene.cloud(), labelled_rows(labels));
  Image<Rgb8> sheet(3 * kWidthPx, 2 * kWidthPx);
  for (int s = 0; s < static_cast<int>(kSideNames.size()) && !job.cancelled(); ++s) {
    const std::vector<glm::vec3> colours = colours_from(seen, seen.sides.at(static_cast<std::size_t>(s)));
    RasterOptions raster;
    raster.colour_override = colours;
    raster.background = glm::vec3(0.1f);
    const Image<Rgb8> side = rgb8_from_linear(
        rasterize(alone, seen.side_cameras.at(static_cast<std::size_t>(s)), raster, job).colour);
    for (int y = 0; y < side.height(); ++y)
      std::ranges::copy(side.row(y), sheet.row(s / 3 * kWidthPx + y).begin() + s % 3 * kWidthPx);
  }
  return sheet;
}

}  // namespace splatcut
