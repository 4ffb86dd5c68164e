// COLMAP: cameras (lenses) and images (poses), as text or binary. Poses are world->camera already.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/mapped_file.h"
#include "core/stand_in.h"
#include "scene/camera/camera_formats.h"
#include "scene/camera/camera_names.h"
#include "scene/cloud/quantise.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

// Index in the table: COLMAP's model id. one_focal: f cx cy ..., otherwise fx fy cx cy ...
struct LensModel {
  const char* name;
  std::size_t params;
  bool one_focal, fisheye;
  std::size_t centre() const { return one_focal ? 1 : 2; }  // index of cx among the parameters
};
constexpr std::array<LensModel, 11> kModels{{{"SIMPLE_PINHOLE", 3, true, false},
                                             {"PINHOLE", 4, false, false},
                                             {"SIMPLE_RADIAL", 4, true, false},
                                             {"RADIAL", 5, true, false},
                                             {"OPENCV", 8, false, false},
                                             {"OPENCV_FISHEYE", 8, false, true},
                                             {"FULL_OPENCV", 12, false, false},
                                             {"FOV", 5, false, true},
                                             {"SIMPLE_RADIAL_FISHEYE", 4, true, true},
                                             {"RADIAL_FISHEYE", 5, true, true},
                                             {"THIN_PRISM_FISHEYE", 12, false, true}}};

// By id. wrong: lenses whose images are left out, and why.
struct Lenses {
  std::map<std::uint32_t, Camera> usable;
  std::map<std::uint32_t, Error> wrong;
};

struct Pose {
  glm::dquat camera_from_world{1, 0, 0, 0};
  glm::dvec3 translation{0};
  std::uint32_t lens = 0;
  std::string name;
};

Camera lens_from(const fs::path& path, std::uint32_t id, const LensModel& model, double width, double height,
                 std::span<const double> params) {
  constexpr double kLargestSide = 1 << 17;
  Camera lens;
  lens.width_px = static_cast<int>(std::clamp(width, 0.0, kLargestSide + 1));
  lens.height_px = static_cast<int>(std::clamp(height, 0.0, kLargestSide + 1));
  const std::size_t centre = model.centre();
  lens.fx_px = static_cast<float>(params[0]);
  lens.fy_px = static_cast<float>(params[centre - 1]);
  lens.cx_px = static_cast<float>(params[centre]);
  lens.cy_px = static_cast<float>(params[centre + 1]);
  check_lens(path, fmt::format("camera {}", id), lens);
  return lens;
}

// Radial models have k after the principal point, the OpenCV models k1 k2 p1 p2 [k3 ...].
Distortion distortion_from(const LensModel& model, std::span<const double> params) {
  const auto after_centre = [&](std::size_t i) {
    const std::size_t at = model.centre() + 2 + i;
    return at < params.size() ? params[at] : 0.0;
  };
  return {after_centre(0), after_centre(1), after_centre(2), after_centre(3), after_centre(4)};
}

// model: null for one that is unknown, by what it is called.
void add_lens(const fs::path& path, std::uint32_t id, const LensModel* model, std::string_view named,
              double width, double height, std::span<const double> params, Lenses* lenses,
              CameraRemarks* remarks) {
  try {
    if (!model) throw Error(path.string(), fmt::format("camera {}: unknown model {}", id, named));
    if (model->fisheye)
      throw Error(path.string(),
                  fmt::format("camera {}: the model {} is not close to a pinhole", id, model->name),
                  "Undistort the pictures first (colmap image_undistorter)");
    const Camera lens = lens_from(path, id, *model, width, height, params);
    lenses->usable[id] = lens;
    remarks->add_shift(corner_shift_px(lens, distortion_from(*model, params)));
  } catch (const Error& error) {
    lenses->wrong.emplace(id, error);
  }
}

// A camera per image, by name: the order in the file is that of a hash table.
class Cameras {
 public:
  Cameras(fs::path path, Lenses lenses, const glm::dvec3& origin, CameraRemarks* remarks)
      : path_(std::move(path)), lenses_(std::move(lenses)), origin_(origin), remarks_(remarks) {}

  void add(const Pose& pose) {
    if (const auto wrong = lenses_.wrong.find(pose.lens); wrong != lenses_.wrong.end())
      return remarks_->leave_out(wrong->second);
    const auto lens = lenses_.usable.find(pose.lens);
    if (lens == lenses_.usable.end())
      return remarks_->leave_out(
          Error(path_.string(),
                fmt::format("image \"{}\" names camera {}, which is missing", pose.name, pose.lens)));
    Camera camera = lens->second;
    camera.name = pose.name;
    const glm::dmat3 world_from_camera =
        glm::transpose(glm::mat3_cast(glm::normalize(pose.camera_from_world)));
    if (!(glm::length(pose.camera_from_world) > 0) ||
        !set_pose(camera, world_from_camera, -(world_from_camera * pose.translation) - origin_))
      return remarks_->leave_out(
          Error(path_.string(), fmt::format("image \"{}\" has no usable pose", pose.name)));
    cameras_.push_back(std::move(camera));
  }
  std::vector<Camera> take() {
    if (cameras_.empty()) remarks_->refuse(path_);
    name_after_pictures(&cameras_);
    std::ranges::stable_sort(cameras_, {}, &Camera::name);
    return std::move(cameras_);
  }

 private:
  fs::path path_;
  Lenses lenses_;
  glm::dvec3 origin_;
  CameraRemarks* remarks_;
  std::vector<Camera> cameras_;
};

// The bytes of a file from front to back.
class BinaryReader {
 public:
  explicit BinaryReader(const fs::path& path) : file_(path), left_(file_.bytes()) {
    refuse_stand_in(path, file_.text());
  }

  const fs::path& path() const { return file_.path(); }
  std::span<const std::byte> skip(std::uint64_t count) {
    if (count > left_.size())
      throw Error(path().string(), fmt::format("truncated: {} bytes are wanted at byte {} of {}", count,
                                               file_.bytes().size() - left_.size(), file_.bytes().size()));
    const auto bytes = left_.first(count);
    left_ = left_.subspan(count);
    return bytes;
  }
  template <class T>
  T read() {
    return load<T>(skip(sizeof(T)).data());
  }
  std::string text() {
    std::string out;
    while (const char c = read<char>()) out += c;
    return out;
  }

 private:
  MappedFile file_;
  std::span<const std::byte> left_;
};

Lenses read_lenses_bin(const fs::path& path, CameraRemarks* remarks) {
  BinaryReader in(path);
  Lenses lenses;
  const auto count = in.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = in.read<std::uint32_t>();
    const auto number = in.read<std::uint32_t>();
    const LensModel* known = number < kModels.size() ? &kModels[number] : nullptr;
    if (!known) throw Error(path.string(), fmt::format("camera {}: unknown model {}", id, number));
    const auto width = static_cast<double>(in.read<std::uint64_t>());
    const auto height = static_cast<double>(in.read<std::uint64_t>());
    std::vector<double> params;
    for (std::size_t p = 0; p < known->params; ++p) params.push_back(in.read<double>());
    add_lens(path, id, known, known->name, width, height, params, &lenses, remarks);
  }
  return lenses;
}

std::vector<Camera> read_images_bin(const fs::path& path, Lenses lenses, const glm::dvec3& origin,
                                    CameraRemarks* remarks) {
  constexpr std::uint64_t kPointBytes = 24;
  BinaryReader in(path);
  Cameras cameras(path, std::move(lenses), origin, remarks);
  const auto count = in.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    Pose pose;
    in.skip(sizeof(std::uint32_t));  // image id
    for (double* v :
         {&pose.camera_from_world.w, &pose.camera_from_world.x, &pose.camera_from_world.y,
          &pose.camera_from_world.z, &pose.translation.x, &pose.translation.y, &pose.translation.z})
      *v = in.read<double>();
    pose.lens = in.read<std::uint32_t>();
    pose.name = in.text();
    const auto points = in.read<std::uint64_t>();
    in.skip(points > (std::uint64_t{1} << 32) ? ~std::uint64_t{0} : points * kPointBytes);
    cameras.add(pose);
  }
  return cameras.take();
}

std::string text_of(const fs::path& path) {
  const MappedFile file(path);
  refuse_stand_in(path, file.text());
  return std::string(file.text());
}

// NaN, too, which a stream does not take for a number.
bool read_numbers(std::istream& words, std::initializer_list<double*> numbers) {
  for (double* number : numbers) {
    std::string word;
    char* end = nullptr;
    if (!(words >> word)) return false;
    *number = std::strtod(word.c_str(), &end);
    if (*end) return false;
  }
  return true;
}

bool is_blank_or_comment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == line.npos || line[first] == '#';
}

Lenses read_lenses_txt(const fs::path& path, CameraRemarks* remarks) {
  std::istringstream in(text_of(path));
  Lenses lenses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (is_blank_or_comment(line)) continue;
    std::istringstream words(line);
    std::uint32_t id = 0;
    std::string name;
    double width = 0, height = 0;
    words >> id >> name >> width >> height;
    if (!words)
      throw Error(path.string(), fmt::format("line {} is not \"id model width height parameters\"", number));
    const auto* known =
        std::ranges::find(kModels, name, [](const LensModel& m) { return std::string_view(m.name); });
    const LensModel* model = known == kModels.end() ? nullptr : known;
    std::vector<double> params(model ? model->params : 0);
    for (double& p : params) words >> p;
    if (!words)
      throw Error(path.string(),
                  fmt::format("line {}: the model {} has {} parameters", number, name, params.size()));
    add_lens(path, id, model, name, width, height, params, &lenses, remarks);
  }
  return lenses;
}

// Triples x y id, or nothing.
bool is_line_of_points(const std::string& line) {
  std::istringstream words(line);
  std::size_t count = 0;
  for (std::string word; words >> word; ++count) {
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    if (*end) return false;
  }
  return count % 3 == 0;
}

// An image's points follow in a line of their own, which may be empty; scripts leave that line out.
std::vector<Camera> read_images_txt(const fs::path& path, Lenses lenses, const glm::dvec3& origin,
                                    CameraRemarks* remarks) {
  std::istringstream in(text_of(path));
  Cameras cameras(path, std::move(lenses), origin, remarks);
  std::string line;
  bool points = false;  // may follow
  for (int number = 1; std::getline(in, line); ++number) {
    if (std::exchange(points, false) && is_line_of_points(line)) continue;
    if (is_blank_or_comment(line)) continue;
    std::istringstream words(line);
    Pose pose;
    std::uint32_t id = 0;
    glm::dquat& q = pose.camera_from_world;
    glm::dvec3& t = pose.translation;
    words >> id;
    const bool has_pose = read_numbers(words, {&q.w, &q.x, &q.y, &q.z, &t.x, &t.y, &t.z});
    words >> pose.lens >> std::ws;
    std::getline(words, pose.name);
    if (pose.name.ends_with('\r')) pose.name.pop_back();
    if (!words || !has_pose || pose.name.empty())
      throw Error(path.string(),
                  fmt::format("line {} is not \"id qw qx qy qz tx ty tz camera name\"", number));
    cameras.add(pose);
    points = true;
  }
  return cameras.take();
}

}  // namespace

bool has_colmap_pair(const fs::path& folder, const std::string& ending) {
  std::error_code ignored;
  return fs::is_regular_file(folder / ("cameras" + ending), ignored) &&
         fs::is_regular_file(folder / ("images" + ending), ignored);
}

const char* colmap_ending(const fs::path& folder) {
  for (const char* ending : {".bin", ".txt"})
    if (has_colmap_pair(folder, ending)) return ending;
  return "";
}

std::vector<Camera> load_colmap_cameras(const fs::path& folder, const std::string& ending,
                                        const glm::dvec3& origin, CameraRemarks* remarks) {
  if (ending == ".bin")
    return read_images_bin(folder / "images.bin", read_lenses_bin(folder / "cameras.bin", remarks), origin,
                           remarks);
  return read_images_txt(folder / "images.txt", read_lenses_txt(folder / "cameras.txt", remarks), origin,
                         remarks);
}

}  // namespace splatcut
