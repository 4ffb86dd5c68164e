// Where the user looks from: orbit, pan, zoom, fly, focus, frame, given cameras. Never part of undo.
//
// State: a camera pose (COLMAP axes), a pivot at `distance` along the view axis, a vertical field of view.
// Moves are in logical pixels of the viewport; lengths in scene units. Transitions take kTransitionSeconds of
// advance().
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>

#include "app/document/camera_pose.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// Steps of a flight: each -1, 0 or 1 along the camera's axes.
struct Flight {
  int right = 0, down = 0, forward = 0;
  float speed = 1;  // of the usual speed
  bool moving() const { return right != 0 || down != 0 || forward != 0; }
};

class CameraController {
 public:
  // scene: what is framed by frame_scene(); outlier Gaussians do not count in it.
  void reset(const Box& scene, const glm::vec3& up_world);
  void change_scene(const Box& scene);  // the view stays as it is

  void orbit(const glm::vec2& delta_px);
  // What lies at `depth` (camera z, scene units; the pivot's where not given) follows the pointer.
  void pan(const glm::vec2& delta_px, float viewport_height_px, std::optional<float> depth = {});
  // Wheel notches; positive goes nearer to the point, which stays where it is in the picture. Without one, to
  // the pivot.
  void zoom(float steps, const std::optional<glm::vec3>& point_world = {});
  void fly(const Flight& flight, float seconds);
  void focus(const glm::vec3& point_world);                  // pivot there, same direction
  void approach(const glm::vec3& point_world, float share);  // the same, at that share of the distance
  // orbit() turns around it as long as it is in front of the camera, and around the pivot otherwise.
  void set_orbit_centre(const glm::vec3& point_world) { orbit_centre_ = point_world; }
  void frame(const Box& box);  // the box fills the picture, same direction
  // The same, within the part of the picture above its lowest covered_bottom_px pixels.
  void frame(const Box& box, const Camera& camera, float covered_bottom_px);
  void frame_scene() { frame(scene_); }
  void go_to(const Camera& camera);                   // the exact pose; the pivot stays at its distance
  void look_along(const glm::vec3& direction_world);  // at the pivot
  void set_up(const glm::vec3& up_world);             // turns the view upright
  void set_fov_y(float fov_y_rad);

  // Moves a running transition on. True while the picture changes.
  bool advance(float seconds);
  void finish_transition();

  const CameraPose& pose() const { return pose_; }
  void set_pose(const CameraPose& pose);
  CameraPose kept_pose() const;  // for files: its pivot is as deep as what orbit() turns around
  const glm::vec3& up_world() const { return up_world_; }
  glm::vec3 pivot_world() const;
  Camera camera(int width_px, int height_px) const;
  float scene_size() const { return scene_size_; }  // diagonal of the framed box, scene units

 private:
  void start(const CameraPose& target);
  glm::vec3 turned_around() const;

  Box scene_;
  float scene_size_ = 1;
  glm::vec3 up_world_{0, -1, 0};
  CameraPose pose_, from_;
  std::optional<CameraPose> target_;
  std::optional<glm::vec3> orbit_centre_;  // world
  float progress_ = 0;
};

}  // namespace splatcut
