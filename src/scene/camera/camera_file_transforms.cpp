// Cameras of NeRF's transforms.json, as nerfstudio writes it, and what both kinds of JSON have alike.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/lower_case.h"
#include "core/picture_file.h"
#include "scene/camera/camera_formats.h"

namespace splatcut {

using nlohmann::json;
namespace fs = std::filesystem;

glm::dvec3 point_of_json(const json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

glm::dmat3 axes_of_json(const json& rows) {
  return glm::transpose(
      glm::dmat3(point_of_json(rows.at(0)), point_of_json(rows.at(1)), point_of_json(rows.at(2))));
}

int side_px(double said) {
  constexpr double kBeyond = 1 << 20;
  return std::isnan(said) ? 0 : static_cast<int>(std::clamp(said, -kBeyond, kBeyond));
}

std::optional<double> number_in(const json& part, const char* name) {
  const auto found = part.find(name);
  if (found == part.end() || found->is_null()) return {};
  if (!found->is_string()) return found->get<double>();
  const auto& text = found->get_ref<const std::string&>();
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end) throw std::domain_error(fmt::format("\"{}\" is no number: {}", name, text));
  return number;
}

double required_number(const json& part, const char* name) {
  if (const auto number = number_in(part, name)) return *number;
  throw std::domain_error(fmt::format("\"{}\" is missing", name));
}

namespace {

// A value of the frame, or else of the whole file.
std::optional<double> lens_number(const json& frame, const json& file, const char* name) {
  const std::optional<double> own = number_in(frame, name);
  return own ? own : number_in(file, name);
}
float lens_value(const json& frame, const json& file, const char* name, float otherwise) {
  return static_cast<float>(lens_number(frame, file, name).value_or(otherwise));
}

// nerfstudio's and COLMAP's names of what is drawn as a pinhole once its distortion is left out.
bool is_like_pinhole(const std::string& model) {
  constexpr std::array kLikePinhole = {"",       "pinhole", "simple_pinhole", "simple_radial",
                                       "radial", "opencv",  "full_opencv",    "perspective"};
  return std::ranges::find(kLikePinhole, model) != kLikePinhole.end();
}

// Throws what each_entry() says of the frame where its lens is far from a pinhole.
void check_model(const json& frame, const json& file) {
  const json named = frame.value("camera_model", file.value("camera_model", json()));
  const std::string model = named.is_string() ? named.get<std::string>() : "";
  const json fisheye = frame.value("is_fisheye", file.value("is_fisheye", json(false)));
  const bool is_fisheye = fisheye.is_number() ? fisheye != 0 : fisheye == true;
  if (is_fisheye || !is_like_pinhole(lower_case(model)))
    throw std::domain_error(
        fmt::format("the model {} is not close to a pinhole: undistort the pictures first",
                    is_fisheye ? "\"is_fisheye\"" : model));
}

// The size of the frame's picture, beside the file.
glm::ivec2 size_of_picture(const fs::path& beside, const fs::path& picture) {
  std::error_code ignored;
  for (const char* ending : {"", ".png", ".jpg", ".jpeg", ".JPG"}) {
    const fs::path path = beside / (picture.string() + ending);
    if (!fs::is_regular_file(path, ignored)) continue;
    if (const auto size = picture_size(path)) return *size;
  }
  throw std::domain_error("\"w\" and \"h\" are missing and " + (beside / picture).string() +
                          " is no PNG or JPEG");
}

}  // namespace

Camera transforms_camera(const fs::path& path, const json& file, const json& frame,
                         const glm::dvec3& origin) {
  Camera camera;
  check_model(frame, file);
  std::string picture = frame.value("file_path", std::string());
  std::ranges::replace(picture, '\\', '/');
  camera.name = picture;
  camera.width_px = side_px(lens_value(frame, file, "w", 0));
  camera.height_px = side_px(lens_value(frame, file, "h", 0));
  if (camera.width_px == 0 ||
      camera.height_px == 0) {  // NeRF's synthetic scenes leave the size to the pictures
    const glm::ivec2 size = size_of_picture(path.parent_path(), picture);
    camera.width_px = size.x;
    camera.height_px = size.y;
  }
  const auto width = static_cast<float>(camera.width_px), height = static_cast<float>(camera.height_px);
  const float angle_x = lens_value(frame, file, "camera_angle_x", 0),
              angle_y = lens_value(frame, file, "camera_angle_y", 0);
  const float from_angle = angle_x > 0 ? 0.5f * width / std::tan(0.5f * angle_x) : 0.0f;
  camera.fx_px = lens_value(frame, file, "fl_x", from_angle);
  const float fy_otherwise = angle_y > 0 ? 0.5f * height / std::tan(0.5f * angle_y) : camera.fx_px;
  camera.fy_px = lens_value(frame, file, "fl_y", fy_otherwise);
  camera.cx_px = lens_value(frame, file, "cx", 0.5f * width);
  camera.cy_px = lens_value(frame, file, "cy", 0.5f * height);
  const json& matrix = frame.at("transform_matrix");
  glm::dmat3 axes = axes_of_json(matrix);  // OpenGL: x right, y up, z back
  axes[1] = -axes[1];
  axes[2] = -axes[2];
  const glm::dvec3 centre(matrix.at(0).at(3).get<double>(), matrix.at(1).at(3).get<double>(),
                          matrix.at(2).at(3).get<double>());
  if (!set_pose(camera, axes, centre - origin)) throw std::domain_error("\"transform_matrix\" is not a pose");
  return camera;
}

Distortion transforms_distortion(const json& file, const json& frame) {
  const auto value = [&](const char* name) { return lens_number(frame, file, name).value_or(0); };
  return {value("k1"), value("k2"), value("p1"), value("p2"), value("k3")};
}

}  // namespace splatcut
