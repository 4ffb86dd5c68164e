#include "app/picture/camera_controller.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "core/ranks.h"

namespace splatcut {

namespace {

constexpr float kTransitionSeconds = 0.25f;
constexpr float kOrbitRadPerPx = 0.006f;
constexpr float kZoomPerStep = 0.88f;
constexpr float kFramesPerRadius = 1.15f;       // a little air around what is framed
constexpr float kFlyDistancesPerSecond = 0.6f;  // to the pivot: fits scenes of any size
constexpr float kPoleRad = 0.02f;               // the view axis never meets the up axis

glm::mat3 world_from_camera(const CameraPose& pose) {
  return glm::transpose(glm::mat3_cast(pose.camera_from_world));
}

// Across `up`, as near to `direction` as that allows.
glm::vec3 level(const glm::vec3& direction, const glm::vec3& up) {
  glm::vec3 across = direction - glm::dot(direction, up) * up;
  if (glm::length(across) < 1e-3f)
    across = glm::cross(up, std::abs(up.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
  return glm::normalize(across);
}

// Upright rotation that looks along `forward`, or short of the pole as orbit() does.
glm::quat looking(const glm::vec3& forward, const glm::vec3& up, const glm::vec3& right_at_pole) {
  glm::vec3 z = glm::normalize(forward), x = glm::cross(z, up);
  if (const float from_pole = glm::length(x); from_pole < std::sin(kPoleRad)) {
    x = level(from_pole > 1e-4f ? x : right_at_pole, up);
    z = std::sin(kPoleRad) * glm::cross(up, x) + std::copysign(std::cos(kPoleRad), glm::dot(z, up)) * up;
  }
  x = glm::normalize(x);
  const glm::vec3 y = glm::cross(z, x);
  return glm::normalize(glm::quat_cast(glm::transpose(glm::mat3(x, y, z))));
}

}  // namespace

void CameraController::change_scene(const Box& scene) {
  scene_ = scene;
  scene_size_ = glm::length(scene.extent());
  if (!(scene_size_ > 0)) scene_size_ = 1;
}

void CameraController::reset(const Box& scene, const glm::vec3& up_world) {
  change_scene(scene);
  up_world_ = glm::normalize(up_world);
  target_.reset();
  orbit_centre_.reset();
  const glm::vec3 sideways = std::abs(up_world_.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 forward = sideways - glm::dot(sideways, up_world_) * up_world_ - 0.35f * up_world_;
  pose_ = CameraPose{};
  pose_.camera_from_world = looking(forward, up_world_, {1, 0, 0});
  frame_scene();
  finish_transition();
}

glm::vec3 CameraController::pivot_world() const {
  return pose_.position_world + pose_.distance * world_from_camera(pose_)[2];
}

// In front, and not far beside what a picture shows.
glm::vec3 CameraController::turned_around() const {
  if (!orbit_centre_) return pivot_world();
  const glm::vec3 seen = glm::mat3_cast(pose_.camera_from_world) * (*orbit_centre_ - pose_.position_world);
  const float beside = 2 * seen.z * std::tan(0.5f * pose_.fov_y_rad);
  const bool in_picture = seen.z > 0 && std::max(std::abs(seen.x), std::abs(seen.y)) < beside;
  return in_picture ? *orbit_centre_ : pivot_world();
}

void CameraController::set_pose(const CameraPose& pose) {
  target_.reset();
  orbit_centre_.reset();
  pose_ = pose;
}

CameraPose CameraController::kept_pose() const {
  CameraPose pose = pose_;
  pose.distance = glm::dot(turned_around() - pose.position_world, world_from_camera(pose)[2]);
  return pose;
}

void CameraController::orbit(const glm::vec2& delta_px) {
  finish_transition();
  const glm::vec3 centre = turned_around();
  const glm::mat3 axes = world_from_camera(pose_);
  const glm::quat around = glm::angleAxis(-delta_px.x * kOrbitRadPerPx, up_world_);
  // Tilt stops short of the poles, where left and right would swap.
  const float elevation = std::asin(std::clamp(glm::dot(axes[2], up_world_), -1.0f, 1.0f));
  constexpr float kRounding = 1e-4f;  // at the pole itself neither is so
  const bool upright = glm::dot(-axes[1], up_world_) > -kRounding;
  float tilt = delta_px.y * kOrbitRadPerPx * (upright ? 1.0f : -1.0f);
  const float limit = glm::half_pi<float>() - kPoleRad;
  tilt = std::clamp(elevation - tilt, -limit, limit) - elevation;
  const glm::quat over = glm::angleAxis(upright ? tilt : -tilt, axes[0]);
  const glm::quat turn = glm::normalize(around * over);
  pose_.camera_from_world = glm::normalize(pose_.camera_from_world * glm::conjugate(turn));
  pose_.position_world = centre + turn * (pose_.position_world - centre);
}

void CameraController::keep_pivot_within(float depth) {
  finish_transition();
  if (turned_around() != pivot_world()) return;
  pose_.distance = std::clamp(depth, std::min(least_distance(), pose_.distance), pose_.distance);
}

void CameraController::pan(const glm::vec2& delta_px, float viewport_height_px, std::optional<float> depth) {
  finish_transition();
  const float per_px =
      2 * depth.value_or(pose_.distance) * std::tan(0.5f * pose_.fov_y_rad) / viewport_height_px;
  const glm::mat3 axes = world_from_camera(pose_);
  pose_.position_world -= per_px * (delta_px.x * axes[0] + delta_px.y * axes[1]);
}

float CameraController::least_distance() const {
  constexpr float kBeyondNearPlane = 1.5f;
  return std::max(1e-4f * scene_size_, kBeyondNearPlane * near_plane_);
}

void CameraController::zoom(float steps, const std::optional<glm::vec3>& point_world) {
  finish_transition();
  const glm::vec3 forward = world_from_camera(pose_)[2];
  const glm::vec3 point = point_world.value_or(pivot_world());
  const float depth = std::max(1e-6f * scene_size_, glm::dot(point - pose_.position_world, forward));
  const float wanted = std::clamp(depth * std::pow(kZoomPerStep, steps), std::min(depth, least_distance()),
                                  1e3f * scene_size_);
  pose_.position_world = point + (wanted / depth) * (pose_.position_world - point);
  pose_.distance = wanted;  // the pivot comes to the depth of what is looked at
}

void CameraController::fly(const Flight& flight, float seconds) {
  finish_transition();
  const glm::mat3 axes = world_from_camera(pose_);
  const glm::vec3 step = static_cast<float>(flight.right) * axes[0] -
                         static_cast<float>(flight.down) * up_world_ +
                         static_cast<float>(flight.forward) * axes[2];
  const float usual = kFlyDistancesPerSecond * std::clamp(pose_.distance, 0.02f * scene_size_, scene_size_);
  pose_.position_world += flight.speed * usual * seconds * step;
  orbit_centre_.reset();
}

void CameraController::focus(const glm::vec3& point_world) {
  CameraPose target = pose_;
  target.distance = std::max(1e-4f * scene_size_, glm::length(point_world - pose_.position_world));
  target.position_world = point_world - target.distance * world_from_camera(pose_)[2];
  start(target);
  orbit_centre_ = point_world;
}

void CameraController::approach(const glm::vec3& point_world, float share) {
  CameraPose target = pose_;
  target.distance = std::max(least_distance(), share * glm::length(point_world - pose_.position_world));
  target.position_world = point_world - target.distance * world_from_camera(pose_)[2];
  start(target);
  orbit_centre_ = point_world;
}

Framing CameraController::framing(std::span<const glm::vec3> points_world, const Camera& camera,
                                  const glm::quat& camera_from_world_rotation, float least_distance) const {
  constexpr float kFilled = 0.8f;
  constexpr std::size_t kMostPoints = 60000;
  constexpr double kOutermost = 0.002;  // of the points, on each side
  constexpr int kRounds = 6;            // perspective moves and scales the silhouette a little less in each
  const auto width = static_cast<float>(camera.width_px), height = static_cast<float>(camera.height_px);
  const glm::vec2 wanted = kFilled * glm::vec2(width / camera.fx_px, height / camera.fy_px);
  CameraPose target = pose_;
  target.camera_from_world = camera_from_world_rotation;
  const glm::mat3 camera_from_world = glm::mat3_cast(camera_from_world_rotation);
  std::vector<glm::vec3> points;  // in the camera's axes
  const std::size_t step = 1 + (points_world.size() - 1) / kMostPoints;
  for (std::size_t i = 0; i < points_world.size(); i += step)
    points.push_back(camera_from_world * points_world[i]);
  const Box box = robust_bounds(points);
  const float radius = std::max(1e-6f * scene_size_, 0.5f * glm::length(box.extent()));
  const float least = 0.5f * box.extent().z + 0.05f * radius;  // all are ahead
  glm::vec3 middle = box.centre();
  target.distance = 4 * radius;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<float> slopes[2];
    for (const glm::vec3& p : points) {
      const float z = p.z - middle.z + target.distance;
      for (int axis = 0; z > 0 && axis < 2; ++axis) slopes[axis].push_back((p[axis] - middle[axis]) / z);
    }
    float filled = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const float low = quantile(&slopes[axis], kOutermost), high = quantile(&slopes[axis], 1 - kOutermost);
      middle[axis] += 0.5f * (low + high) * target.distance;
      filled = std::max(filled, (high - low) / wanted[axis]);
    }
    target.distance = std::max(least, target.distance * std::max(filled, 1e-3f));
  }
  target.distance = std::max({target.distance, least_distance, near_plane_ + least});
  const glm::mat3 axes = world_from_camera(target);
  const glm::vec3 middle_world = axes * middle;
  target.position_world = middle_world - target.distance * axes[2];
  return {target, middle_world};
}

void CameraController::frame(const Framing& framing) {
  start(framing.pose);
  orbit_centre_ = framing.middle_world;
}

std::vector<glm::quat> CameraController::directions_around() const {
  const glm::mat3 axes = world_from_camera(pose_);
  std::vector<std::pair<float, glm::quat>> around;  // by the cosine of the angle
  for (const float down_deg : {0.0f, 20.0f, 40.0f, -20.0f})
    for (const float aside_deg : {0.0f, 22.0f, -22.0f, 44.0f, -44.0f}) {
      const glm::quat down = glm::angleAxis(-glm::radians(down_deg), axes[0]),
                      aside = glm::angleAxis(glm::radians(aside_deg), up_world_);
      const glm::vec3 forward = aside * (down * axes[2]);
      const float cosine = glm::dot(forward, axes[2]);
      if (cosine >= std::cos(glm::radians(45.0f)) && cosine < std::cos(glm::radians(10.0f)))
        around.emplace_back(cosine, looking(forward, up_world_, axes[0]));
    }
  std::ranges::stable_sort(around, std::ranges::greater(), [](const auto& side) { return side.first; });
  std::vector<glm::quat> rotations;
  for (const auto& [cosine, rotation] : around) rotations.push_back(rotation);
  return rotations;
}

void CameraController::frame(const Box& box) {
  CameraPose target = pose_;
  const float radius = std::max(1e-6f * scene_size_, 0.5f * glm::length(box.extent()));
  target.distance = kFramesPerRadius * radius / std::sin(0.5f * pose_.fov_y_rad);
  target.position_world = box.centre() - target.distance * world_from_camera(pose_)[2];
  start(target);
  orbit_centre_ = box.centre();
}

void CameraController::go_to(const Camera& camera) {
  CameraPose target = pose_;
  target.camera_from_world = glm::normalize(glm::quat_cast(camera.camera_from_world_rotation));
  target.position_world = camera.centre_world();
  target.fov_y_rad = 2 * std::atan(0.5f * static_cast<float>(camera.height_px) / camera.fy_px);
  // The pivot is what the camera looks at: the scene's middle, where it lies ahead.
  const float ahead = glm::dot(scene_.centre() - target.position_world, camera.forward_world());
  if (ahead > 1e-3f * scene_size_) target.distance = ahead;
  start(target);
}

void CameraController::go_to_standing(const Camera& camera) {
  constexpr float kSays = 0.2f;  // of up across the view axis: straight down, no side is up
  go_to(camera);
  const glm::vec2 up_right_down(camera.camera_from_world_rotation * up_world_);
  const bool stands = -up_right_down.y >= std::abs(up_right_down.x);
  if (stands || glm::length(up_right_down) < kSays) return;
  const bool on_side = std::abs(up_right_down.x) > up_right_down.y;
  if (on_side) target_->fov_y_rad = 2 * std::atan(0.5f * static_cast<float>(camera.width_px) / camera.fx_px);
  turn_upright(&*target_);
}

void CameraController::keep_opening(const glm::vec3& scenes_up_world) {
  opening_ = goal();
  opening_up_world_ = glm::normalize(scenes_up_world);
}

void CameraController::go_to_opening() {
  CameraPose target = opening_;
  constexpr float kSameDirection = 0.99999f;  // cosine
  if (glm::dot(opening_up_world_, up_world_) < kSameDirection) turn_upright(&target);
  start(target);
}

glm::quat CameraController::rotation_along(const glm::vec3& direction_world) const {
  return looking(direction_world, up_world_, world_from_camera(pose_)[0]);
}

void CameraController::look_along(const glm::vec3& direction_world) {
  CameraPose target = pose_;
  const glm::vec3 pivot = pivot_world();
  target.camera_from_world = rotation_along(direction_world);
  target.position_world = pivot - target.distance * world_from_camera(target)[2];
  start(target);
}

void CameraController::set_up(const glm::vec3& up_world) {
  up_world_ = glm::normalize(up_world);
  CameraPose target = pose_;
  turn_upright(&target);
  start(target);
}

void CameraController::turn_upright(CameraPose* pose) const {
  const glm::mat3 axes = world_from_camera(*pose);
  const glm::vec3 pivot = pose->position_world + pose->distance * axes[2];
  pose->camera_from_world = looking(axes[2], up_world_, axes[0]);
  pose->position_world = pivot - pose->distance * world_from_camera(*pose)[2];
}

void CameraController::set_fov_y(float fov_y_rad) {
  finish_transition();
  pose_.fov_y_rad = std::clamp(fov_y_rad, glm::radians(5.0f), glm::radians(140.0f));
}

void CameraController::start(const CameraPose& target) {
  from_ = pose_;
  target_ = target;
  progress_ = 0;
}

bool CameraController::advance(float seconds) {
  if (!target_) return false;
  progress_ += seconds / kTransitionSeconds;
  if (progress_ >= 1) {
    finish_transition();
    return true;
  }
  const float t = progress_ * progress_ * (3 - 2 * progress_);
  pose_.camera_from_world = glm::slerp(from_.camera_from_world, target_->camera_from_world, t);
  pose_.position_world = glm::mix(from_.position_world, target_->position_world, t);
  pose_.distance = glm::mix(from_.distance, target_->distance, t);
  pose_.fov_y_rad = glm::mix(from_.fov_y_rad, target_->fov_y_rad, t);
  return true;
}

void CameraController::finish_transition() {
  if (target_) pose_ = *target_;
  target_.reset();
}

Camera camera_at(const CameraPose& pose, int width_px, int height_px) {
  Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fy_px = 0.5f * static_cast<float>(height_px) / std::tan(0.5f * pose.fov_y_rad);
  camera.fx_px = camera.fy_px;
  camera.cx_px = 0.5f * static_cast<float>(width_px);
  camera.cy_px = 0.5f * static_cast<float>(height_px);
  camera.camera_from_world_rotation = glm::mat3_cast(pose.camera_from_world);
  camera.camera_from_world_translation = -(camera.camera_from_world_rotation * pose.position_world);
  return camera;
}

}  // namespace splatcut
