// Readers of one camera format each; camera_file.cpp chooses. Internal to src/scene.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <string>

#include "core/error.h"
#include "scene/camera/camera_file.h"

namespace splatcut {

// Lens distortion after Brown (1971), OpenCV's names: radial k, tangential p.
struct Distortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

// How far the distortion moves the corner of the picture that it moves farthest, pixels.
double corner_shift_px(const Camera& camera, const Distortion& distortion);

// What is to be said of cameras that were read.
class CameraRemarks {
 public:
  void add_shift(double shift_px) { largest_shift_px_ = std::max(largest_shift_px_, shift_px); }  // of a lens
  void leave_out(const Error& error);  // a camera that is not one
  // Throws Error where no camera is left: what was wrong with the first.
  [[noreturn]] void refuse(const std::filesystem::path& path) const;
  std::string sentence(const std::filesystem::path& path) const;  // empty for nothing

 private:
  double largest_shift_px_ = 0;
  std::size_t left_out_ = 0;
  std::string first_;
};

// folder holds cameras and images, both .bin or both .txt (.bin is preferred).
std::vector<Camera> load_colmap_cameras(const std::filesystem::path& folder, CameraRemarks* remarks);
bool has_colmap_cameras(const std::filesystem::path& folder);

// The pose from the camera's axes and centre in the world; the axes are made unit length. False when
// they are no rotation.
bool set_pose(Camera& camera, const glm::dmat3& world_from_camera, const glm::dvec3& centre_world);

// Throws Error for a picture size or focal length that is not positive and finite.
void check_lens(const std::filesystem::path& path, std::string_view entry, const Camera& camera);

}  // namespace splatcut
