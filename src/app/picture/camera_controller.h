// The user's camera, and what moves it: orbit, pan, zoom, flight, focus, framing, given cameras. Undo does
// not move it.
//
// State: a camera pose (COLMAP axes), a pivot at `distance` along the view axis, a vertical field of view.
// Moves are in logical pixels of the viewport unless said otherwise, lengths in scene units. A transition
// takes kTransitionSeconds of advance().
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>
#include <vector>

#include "app/document/camera_pose.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// Direction of a flight: -1, 0 or 1 along the camera's x and z axes, and against the up direction.
struct Flight {
  int right = 0, down = 0, forward = 0;
  float speed = 1;  // speed over the usual one
  bool moving() const { return right != 0 || down != 0 || forward != 0; }
};

// A camera pose that shows points, and their middle.
struct Framing {
  CameraPose pose;
  glm::vec3 middle_world{0};
};

Camera camera_at(const CameraPose& pose, int width_px, int height_px);

class CameraController {
 public:
  // Starts with another scene. scene: its robust bounds, which frame_scene() frames.
  void reset(const Box& scene, const glm::vec3& up_world);
  void change_scene(const Box& scene);  // sets new bounds and leaves the view as it is
  // Pictures leave out what is nearer than that, scene units: nothing is framed or zoomed to out of sight.
  void set_near_plane(float near_plane) { near_plane_ = near_plane; }

  void orbit(const glm::vec2& delta_px);
  // orbit() turns around a pivot no farther away than that, where there is no orbit centre: a room's middle
  // may lie behind the wall that is looked at. depth: camera z, scene units.
  void keep_pivot_within(float depth);
  // Pans so that what lies at `depth` follows the pointer. depth: camera z, scene units; none: the pivot's.
  // viewport_height_px: height in the pixels of delta_px.
  void pan(const glm::vec2& delta_px, float viewport_height_px, std::optional<float> depth = {});
  // Moves towards the point (none: the pivot), which stays in place in the picture. steps: notches of the
  // wheel; positive: nearer.
  void zoom(float steps, const std::optional<glm::vec3>& point_world = {});
  void fly(const Flight& flight, float seconds);
  void focus(const glm::vec3& point_world);                  // brings the point to the middle, as the pivot
  void approach(const glm::vec3& point_world, float share);  // focus() at that share of the distance
  // Sets the point that orbit() turns around while it is in front of the camera and in or near the picture.
  // Else orbit() turns around the pivot.
  void set_orbit_centre(const glm::vec3& point_world) { orbit_centre_ = point_world; }
  void frame(const Box& box);  // lets the box fill the picture, from the same direction
  void frame(const Framing& framing);
  // The pose in which the points, one or more, fill four fifths of the picture, with their silhouette in its
  // middle. Of the points two in a thousand on each side do not count. least_distance: distance of the pose
  // from their middle, scene units, at least.
  Framing framing(std::span<const glm::vec3> points_world, const Camera& camera,
                  const glm::quat& camera_from_world, float least_distance = 0) const;
  // Directions up to 45 degrees from the present one, upright, the nearest first: rotations of the camera.
  std::vector<glm::quat> directions_around() const;
  void frame_scene() { frame(scene_); }
  void go_to(const Camera& camera);  // takes its exact pose and field of view
  // The same, but a picture that was taken on its side or upside down stands upright, as high as it is wide.
  void go_to_standing(const Camera& camera);
  // Keeps where a transition ends as the view in which the scene opened, to which go_to_opening() goes back:
  // upright where the up direction is another one than the scene's then.
  void keep_opening(const glm::vec3& scenes_up_world);
  void go_to_opening();
  void look_along(const glm::vec3& direction_world);                 // looks at the pivot along the direction
  glm::quat rotation_along(const glm::vec3& direction_world) const;  // rotation of the camera that does
  void set_up(const glm::vec3& up_world);  // sets the up direction and turns the view upright
  void set_fov_y(float fov_y_rad);         // sets the field of view, clamped to 5 to 140 degrees

  // Moves a running transition on. Returns true while the picture changes.
  bool advance(float seconds);
  void finish_transition();

  const CameraPose& pose() const { return pose_; }
  const CameraPose& goal() const { return target_ ? *target_ : pose_; }  // where a running transition ends
  void set_pose(const CameraPose& pose);
  CameraPose kept_pose() const;  // pose for files: its pivot has the depth of the orbit centre
  const glm::vec3& up_world() const { return up_world_; }
  glm::vec3 pivot_world() const;
  glm::vec3 turned_around() const;  // point that orbit() turns around
  Camera camera(int width_px, int height_px) const { return camera_at(pose_, width_px, height_px); }
  float scene_size() const { return scene_size_; }  // diagonal of the scene's bounds, scene units

 private:
  void start(const CameraPose& target);
  void turn_upright(CameraPose* pose) const;  // about its pivot
  float least_distance() const;               // of what is looked at

  Box scene_;
  float scene_size_ = 1, near_plane_ = 0;
  glm::vec3 up_world_{0, -1, 0};
  CameraPose pose_, from_, opening_;
  glm::vec3 opening_up_world_{0, -1, 0};
  std::optional<CameraPose> target_;
  std::optional<glm::vec3> orbit_centre_;  // centre in world coordinates; none: the pivot
  float progress_ = 0;
};

}  // namespace splatcut
