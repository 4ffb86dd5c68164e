// Readers of one camera format each; camera_file.cpp chooses. Internal to src/scene.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/json_file.h"
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

// What cameras and images of COLMAP, which lie beside each other, end with: ".bin", else ".txt"; empty where
// the folder has no such pair.
const char* colmap_ending(const std::filesystem::path& folder);
bool has_colmap_pair(const std::filesystem::path& folder, const std::string& ending);
// origin: as in load_cameras().
std::vector<Camera> load_colmap_cameras(const std::filesystem::path& folder, const std::string& ending,
                                        const glm::dvec3& origin, CameraRemarks* remarks);

// The frame of a transforms.json. path: of the file, beside which its pictures are. Throws json::exception or
// domain_error, whose words are about the frame.
Camera transforms_camera(const std::filesystem::path& path, const nlohmann::json& file,
                         const nlohmann::json& frame, const glm::dvec3& origin);
Distortion transforms_distortion(const nlohmann::json& file, const nlohmann::json& frame);

// A number, which some tools write as text; none where it is missing or null. Throws domain_error for other
// text, the second also for none.
std::optional<double> number_in(const nlohmann::json& part, const char* name);
double required_number(const nlohmann::json& part, const char* name);

// A side as an int; one beyond all pictures stays beyond them, for check_lens() to refuse.
int side_px(double said);

// Rows as in the file; further columns and rows of a 4x4 matrix are not looked at.
glm::dmat3 axes_of_json(const nlohmann::json& rows);
glm::dvec3 point_of_json(const nlohmann::json& list);

// The pose from the camera's axes and centre in the world; the axes are made unit length. False when
// they are no rotation.
bool set_pose(Camera& camera, const glm::dmat3& world_from_camera, const glm::dvec3& centre_world);

// Throws Error for a picture size or focal length that is not positive and finite.
void check_lens(const std::filesystem::path& path, std::string_view entry, const Camera& camera);

}  // namespace splatcut
