#include "segment/superpoints/neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "segment/superpoints/orbit.h"
#include "segment/superpoints/usual_picture.h"

namespace splatcut {

namespace {

// The slab between a face of the cell and an eighth of a side beyond it.
Box beyond(const Box& box, int axis, bool high, float side) {
  Box slab = box;
  slab.min[axis] = high ? box.max[axis] : box.min[axis] - side / 8;
  slab.max[axis] = high ? box.max[axis] + side / 8 : box.min[axis];
  return slab;
}

}  // namespace

float Cell::side() const {
  return std::ldexp(1.0f, level);
}

glm::vec3 Cell::centre_world() const {
  return 0.25f * side() * glm::vec3(x, y, z);
}

Box Cell::box_world() const {
  return {centre_world() - 0.5f * side(), centre_world() + 0.5f * side()};
}

Cell cell_around(const glm::vec3& point_world, int level) {
  const glm::vec3 at = glm::round(point_world / (0.25f * std::ldexp(1.0f, level)));
  return {level, static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)};
}

int nearest_level(float length) {
  return static_cast<int>(std::lround(std::log2(length)));
}

int level_above(float length) {
  return static_cast<int>(std::ceil(std::log2(length)));
}

bool Place::operator==(const Place& other) const {
  return cell == other.cell && looked_at == other.looked_at && whole == other.whole &&
         closer == other.closer && same_camera(eye, other.eye);
}

std::size_t Neighbourhood::bytes() const {
  constexpr std::size_t kPerGaussian = 600;  // its copy, graph, solver and parts, measured
  return cloud ? kPerGaussian * cloud->size() : 0;
}

std::vector<Camera> views_around(const WholeScene& scene, const Place& place,
                                 const ObservingOptions& options) {
  std::vector<Camera> views{limited_to_width(place.eye, options.width_px)}, given;
  const glm::vec3 centre = place.looked_at.centre_world();
  std::ranges::copy_if(scene.capture.photographs, std::back_inserter(given),
                       [&](const Camera& camera) { return camera.shows(centre); });
  const std::size_t n = std::min<std::size_t>(given.size(), static_cast<std::size_t>(options.most_given));
  for (std::size_t i = 0; i < n; ++i)
    views.push_back(limited_to_width(given[i * given.size() / n], options.width_px));
  if (std::ssize(given) >= kEnoughPhotographs) return views;
  OrbitOptions orbit;
  orbit.views = options.ring;
  orbit.elevation_swing_rad = options.elevation_swing_rad;
  // What is clicked is the near side of a thing: at its own distance, views from behind would cut it off.
  constexpr float kFarther = 1.5f;
  const float distance = kFarther * place.closer * glm::distance(place.eye.centre_world(), centre);
  const ObjectExtent extent{centre, distance / (2 * orbit.distance_sizes)};
  std::ranges::copy(orbit_cameras(views.front(), scene.up_world, extent, orbit), std::back_inserter(views));
  return views;
}

Neighbourhood prepare_neighbourhood(const WholeScene& scene, const Place& place,
                                    const PrepareOptions* options, const Job& job) {
  Neighbourhood near{.place = place, .row = {}, .cloud = scene.cloud, .prepared = nullptr};
  if (!place.whole) {
    near.row = scene.blocks->rows_in(*scene.cloud, place.cell.box_world());
    near.cloud = std::make_shared<const GaussianCloud>(permuted(*scene.cloud, near.row));
  }
  PreparedScene prepared;
  if (options)
    prepared = prepare_scene(*near.cloud, views_around(scene, place, options->observing), *options, job);
  near.prepared = std::make_shared<const PreparedScene>(std::move(prepared));
  return near;
}

bool touches_side(const WholeScene& scene, const Neighbourhood& near, std::span<const std::uint8_t> labels) {
  constexpr float kBandSides = 1.0f / 16;
  constexpr double kLeastShare = 0.01;
  if (near.place.whole) return false;
  const Box box = near.place.cell.box_world();
  const float side = near.place.cell.side(), band = kBandSides * side;
  std::array<std::size_t, 6> at_face{};
  std::size_t all = 0;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (!labels[g]) continue;
    ++all;
    const glm::vec3& p = near.cloud->position[g];
    for (int axis = 0; axis < 3; ++axis) {
      at_face[static_cast<std::size_t>(2 * axis)] += p[axis] < box.min[axis] + band;
      at_face[static_cast<std::size_t>(2 * axis + 1)] += p[axis] > box.max[axis] - band;
    }
  }
  for (int face = 0; face < 6; ++face) {
    const auto there = static_cast<double>(at_face[static_cast<std::size_t>(face)]);
    if (there > kLeastShare * static_cast<double>(all) &&
        scene.blocks->count_in(*scene.cloud, beyond(box, face / 2, face % 2 == 1, side)) > 0)
      return true;
  }
  return false;
}

}  // namespace splatcut
