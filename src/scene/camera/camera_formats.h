// Readers of one camera format each; camera_file.cpp chooses. Internal to src/scene.
#pragma once

#include <glm/glm.hpp>

#include "scene/camera/camera_file.h"

namespace splatcut {

// Lens distortion after Brown (1971), OpenCV's names: radial k, tangential p.
struct Distortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

// How far the distortion moves the corner of the picture that it moves farthest, pixels.
double corner_shift_px(const Camera& camera, const Distortion& distortion);

// folder holds cameras and images, both .bin or both .txt (.bin is preferred). largest_shift_px: raised to
// the largest corner shift of its lenses.
std::vector<Camera> load_colmap_cameras(const std::filesystem::path& folder, double& largest_shift_px);
bool has_colmap_cameras(const std::filesystem::path& folder);

// The pose from the camera's axes and centre in the world; the axes are made unit length. False when
// they are no rotation.
bool set_pose(Camera& camera, const glm::dmat3& world_from_camera, const glm::dvec3& centre_world);

// Throws Error for a picture size or focal length that is not positive and finite.
void check_lens(const std::filesystem::path& path, std::string_view entry, const Camera& camera);

}  // namespace splatcut
