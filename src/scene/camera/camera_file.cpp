// Cameras from JSON: the list that Inria's training writes, and NeRF's transforms.json.
#include "scene/camera/camera_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "core/json_file.h"
#include "core/lower_case.h"
#include "core/mapped_file.h"
#include "scene/camera/camera_formats.h"
#include "scene/camera/camera_names.h"

namespace splatcut {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// Python writes NaN and Infinity, which are no JSON, where a pose failed. As null they spoil one camera
// alone.
std::string without_nan(std::string_view text) {
  std::string json_alone;
  bool in_string = false;
  while (!text.empty()) {
    std::size_t taken = in_string && text[0] == '\\' ? std::min<std::size_t>(2, text.size()) : 1;
    if (text[0] == '"') in_string = !in_string;
    bool number = false;
    for (const std::string_view word : {"-Infinity", "Infinity", "NaN"})
      if (!in_string && text.starts_with(word)) number = true, taken = word.size();
    json_alone += number ? "null" : text.substr(0, taken);
    text.remove_prefix(taken);
  }
  return json_alone;
}

// No pipe: nobody may have named this file.
json json_of_regular_file(const fs::path& path) {
  const MappedFile file(path);
  const std::string_view text = file.text();
  const bool has_nan = text.find("NaN") != text.npos || text.find("Infinity") != text.npos;
  return has_nan ? parse_json(path, without_nan(text)) : parse_json(path, text);
}

Camera inria_camera(const json& entry, const glm::dvec3& origin) {
  Camera camera;
  const json name = entry.value("img_name", json(""));
  camera.name = name.is_string() ? name.get<std::string>() : json_text(name);
  const auto number = [&](const char* key) { return required_number(entry, key); };
  camera.width_px = side_px(number("width"));
  camera.height_px = side_px(number("height"));
  camera.fx_px = static_cast<float>(number("fx"));
  camera.fy_px = static_cast<float>(number("fy"));
  camera.cx_px = static_cast<float>(number_in(entry, "cx").value_or(0.5 * camera.width_px));
  camera.cy_px = static_cast<float>(number_in(entry, "cy").value_or(0.5 * camera.height_px));
  if (!set_pose(camera, axes_of_json(entry.at("rotation")), point_of_json(entry.at("position")) - origin))
    throw std::domain_error("\"rotation\" or \"position\" is not a pose");
  return camera;
}

// One camera per entry of the list. What is wrong with an entry is said with its number; it is thrown where
// no entry is right.
template <class Read>
std::vector<Camera> each_entry(const fs::path& path, const json& list, const char* kind, Read read,
                               CameraRemarks* remarks) {
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string entry = fmt::format("{} {}", kind, i);
    try {
      Camera camera = read(list[i]);
      check_lens(path, entry, camera);
      cameras.push_back(std::move(camera));
    } catch (const json::exception& error) {
      remarks->leave_out(Error(path.string(), fmt::format("{}: {}", entry, fault_of(error))));
    } catch (const std::domain_error& error) {
      remarks->leave_out(Error(path.string(), fmt::format("{}: {}", entry, error.what())));
    } catch (const Error& error) {
      remarks->leave_out(error);
    }
  }
  if (cameras.empty()) remarks->refuse(path);
  name_after_pictures(&cameras);
  return cameras;
}

std::vector<Camera> load_json_cameras(const fs::path& path, const glm::dvec3& origin,
                                      CameraRemarks* remarks) {
  const json file = json_of_regular_file(path);
  if (file.is_array())
    return each_entry(
        path, file, "camera", [&](const json& entry) { return inria_camera(entry, origin); }, remarks);
  if (file.is_object() && file.contains("frames") && file["frames"].is_array()) {
    const auto read = [&](const json& frame) {
      const Camera camera = transforms_camera(path, file, frame, origin);
      remarks->add_shift(corner_shift_px(camera, transforms_distortion(file, frame)));
      return camera;
    };
    return each_entry(path, file["frames"], "frame", read, remarks);
  }
  throw Error(path.string(), "is neither a list of cameras (Inria) nor an object with \"frames\" (NeRF)");
}

}  // namespace

bool set_pose(Camera& camera, const glm::dmat3& world_from_camera, const glm::dvec3& centre_world) {
  glm::dmat3 axes = world_from_camera;
  for (int column = 0; column < 3; ++column) axes[column] /= glm::length(axes[column]);
  constexpr double kTolerance = 0.01;
  const bool finite_centre = std::isfinite(centre_world.x + centre_world.y + centre_world.z);
  if (!(std::abs(glm::determinant(axes) - 1.0) < kTolerance) || !finite_centre) return false;
  const glm::dmat3 camera_from_world = glm::transpose(axes);
  camera.camera_from_world_rotation = glm::mat3(camera_from_world);
  camera.camera_from_world_translation = glm::vec3(-(camera_from_world * centre_world));
  return true;
}

void check_lens(const fs::path& path, std::string_view entry, const Camera& camera) {
  constexpr int kLargestSide = 1 << 17;
  const bool size = camera.width_px > 0 && camera.height_px > 0 && camera.width_px <= kLargestSide &&
                    camera.height_px <= kLargestSide;
  if (!size)
    throw Error(path.string(),
                fmt::format("{}: a picture of {} x {} pixels", entry, camera.width_px, camera.height_px));
  const bool focal =
      camera.fx_px > 0 && camera.fy_px > 0 && std::isfinite(camera.fx_px) && std::isfinite(camera.fy_px);
  if (!focal || !std::isfinite(camera.cx_px) || !std::isfinite(camera.cy_px))
    throw Error(path.string(), fmt::format("{}: focal lengths {} and {}, principal point {}, {}", entry,
                                           camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px));
}

double corner_shift_px(const Camera& camera, const Distortion& d) {
  double farthest = 0;
  for (const int u : {0, camera.width_px})
    for (const int v : {0, camera.height_px}) {
      const double x = (static_cast<float>(u) - camera.cx_px) / camera.fx_px;
      const double y = (static_cast<float>(v) - camera.cy_px) / camera.fy_px;
      const double r2 = x * x + y * y, radial = r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
      const double dx = x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x);
      const double dy = y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
      farthest = std::max(farthest, std::hypot(dx * camera.fx_px, dy * camera.fy_px));
    }
  return farthest;
}

namespace {

// Where COLMAP's model lies in the folders of a capture, as COLMAP, nerfstudio and Inria's scripts lay it
// out.
constexpr std::array kColmapFolders = {"",
                                       "0",
                                       "sparse/0",
                                       "sparse",
                                       "colmap/sparse/0",
                                       "colmap/sparse",
                                       "dense/sparse",
                                       "dense/0/sparse",
                                       "undistorted/sparse",
                                       "distorted/sparse/0"};

// Files of other programs, which write what is read as well, and files that hold no cameras.
void refuse_other_files(const fs::path& path) {
  const std::string ending = lower_case(path.extension().string());
  if (ending == ".csv")
    throw Error(path.string(), "is a list of cameras (RealityCapture), which is not read",
                "Export COLMAP there: \"Internal/External camera parameters\" for COLMAP, as text");
  if (ending == ".xml")
    throw Error(path.string(), "holds cameras of Metashape, which are not read",
                "Export COLMAP there: File > Export > Export Cameras, type Colmap");
  constexpr std::array kNoCameras = {".ply",  ".splat", ".spz", ".sog", ".ksplat", ".lcc",
                                     ".gltf", ".glb",   ".png", ".jpg", ".jpeg",   ".webp"};
  if (std::ranges::find(kNoCameras, ending) != kNoCameras.end())
    throw Error(path.string(), "is a scene or a picture, no list of cameras",
                "Give cameras.json, transforms.json or a COLMAP folder");
}

std::vector<Camera> load_any_cameras(const fs::path& path, const glm::dvec3& origin, CameraRemarks* remarks) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) throw Error(path.string(), "there is no such file or folder");
  if (fs::is_directory(path, ignored)) {
    for (const char* folder : kColmapFolders)
      if (const std::string ending = colmap_ending(path / folder); !ending.empty())
        return load_colmap_cameras(path / folder, ending, origin, remarks);
    for (const char* name : {"cameras.json", "transforms.json"})
      if (fs::exists(path / name, ignored)) return load_json_cameras(path / name, origin, remarks);
    throw Error(
        path.string(),
        "the folder has no cameras: cameras.json, transforms.json and COLMAP's cameras and images are "
        "looked for, those also in " +
            fmt::format("{}", fmt::join(kColmapFolders.begin() + 1, kColmapFolders.end(), ", ")));
  }
  refuse_other_files(path);
  const bool colmap = path.extension() == ".bin" || path.extension() == ".txt";
  if (!colmap) return load_json_cameras(path, origin, remarks);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string ending = path.extension().string();
  if (!has_colmap_pair(folder, ending))
    throw Error(path.string(),
                "cameras and images of COLMAP are wanted beside each other, both .bin or both .txt");
  return load_colmap_cameras(folder, ending, origin, remarks);
}

}  // namespace

void CameraRemarks::leave_out(const Error& error) {
  if (left_out_++ == 0) first_ = error.unstopped();
}

void CameraRemarks::refuse(const fs::path& path) const {
  if (left_out_ > 0) throw Error(first_, "and no camera is left");
  throw Error(path.string(), "holds no cameras");
}

std::string CameraRemarks::sentence(const fs::path& path) const {
  std::string text;
  if (left_out_ > 0)
    text = fmt::format(
        "{}. {} left out; numbers count the others", first_,
        left_out_ == 1 ? "This camera is" : fmt::format("This camera and {} more are", left_out_ - 1));
  constexpr double kVisiblePx = 0.1;
  if (largest_shift_px_ >= kVisiblePx)
    text += fmt::format(
        "{}{}: the lens distortion, up to {:.1f} pixels in the corners, is left out; masks and clicks on the "
        "photographs themselves are off by as much (colmap image_undistorter makes pictures without it)",
        text.empty() ? "" : ". ", path.string(), largest_shift_px_);
  return text;
}

std::vector<Camera> load_cameras(const fs::path& path, std::string* warning, const glm::dvec3& origin) {
  CameraRemarks remarks;
  std::vector<Camera> cameras = load_any_cameras(path, origin, &remarks);
  if (warning) *warning = remarks.sentence(path);
  return cameras;
}

}  // namespace splatcut
