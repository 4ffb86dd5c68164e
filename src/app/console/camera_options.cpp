#include "app/console/camera_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "app/console/command_line.h"
#include "core/error.h"
#include "core/spoken_list.h"
#include "scene/camera/camera_file.h"
#include "scene/camera/camera_names.h"
#include "scene/camera/common_up.h"
#include "scene/cloud/scene_memory.h"
#include "scene/raster/first_view.h"
#include "scene/raster/guessed_up.h"

namespace splatcut {

namespace {

constexpr int kDefaultWidth = 1008, kDefaultHeight = 756, kMaxSide = 16384;

std::pair<int, int> parse_size(const std::string& text) {
  int width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto [x, bad_width] = std::from_chars(text.data(), end, width);
  const auto [last, bad_height] = std::from_chars(std::min(x + 1, end), end, height);
  const bool two = bad_width == std::errc() && bad_height == std::errc() && *x == 'x' && last == end;
  if (!two || width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    throw Error("--size " + text, "is not a picture size",
                fmt::format("Write it as WxH, each from 1 to {}", kMaxSide));
  return {width, height};
}

// Where the window would stand: the picture's size has no say in it.
Camera first_view(const GaussianCloud& cloud, const glm::vec3& up, float fov_y_rad, int width, int height) {
  constexpr int kGuessWidth = 640, kGuessHeight = 480;
  const Box bounds = framed_bounds(cloud);
  const Camera all = view_of_all(bounds, up, fov_y_rad, kGuessWidth, kGuessHeight);
  return resized(better_first_view(cloud, bounds, up, all).value_or(all), width, height);
}

// Over a sample of both.
bool any_sees(const std::vector<Camera>& cameras, const GaussianCloud& cloud) {
  constexpr std::size_t kCameras = 64, kGaussians = 1000;
  const std::size_t camera_step = (cameras.size() + kCameras - 1) / kCameras,
                    step = (cloud.size() + kGaussians - 1) / kGaussians;
  for (std::size_t c = 0; c < cameras.size(); c += camera_step)
    for (std::size_t g = 0; g < cloud.size(); g += step) {
      const glm::vec3 at = cameras[c].camera_from_world(cloud.position[g]);
      if (!(at.z > 0)) continue;
      const glm::vec2 px = cameras[c].pixel_from_camera(at);
      if (px.x >= 0 && px.y >= 0 && px.x < static_cast<float>(cameras[c].width_px) &&
          px.y < static_cast<float>(cameras[c].height_px))
        return true;
    }
  return false;
}

// A guess is no reason to refuse a view straight down.
glm::vec3 up_for(const CameraOptions& options, const glm::vec3& forward, const glm::vec3& up) {
  constexpr float kParallel = 1e-3f;
  const bool parallel =
      glm::length(glm::cross(forward, up)) < kParallel * glm::length(forward) * glm::length(up);
  if (!parallel || !options.up.empty() || !options.cameras.empty()) return up;
  return std::abs(up.y) > 0.5f ? glm::vec3(0, 0, 1) : glm::vec3(0, -1, 0);
}

// Of those left out, the one that was asked for may be one.
const Camera& asked_camera(const CameraOptions& options, const ChosenCamera& chosen) {
  try {
    return find_camera(chosen.given, options.camera.empty() ? "0" : options.camera, options.cameras.string());
  } catch (const Error& error) {
    if (chosen.warning.empty()) throw;
    throw Error(error.unstopped(), chosen.warning);
  }
}

}  // namespace

void CameraOptions::add_to(CLI::App& command) {
  command.add_option("--cameras", cameras, "cameras.json, transforms.json or a COLMAP folder");
  command.add_option("--camera", camera, "Which of the cameras: its name, or its number from 0");
  command.add_option("--camera-pos", position, "Camera position x,y,z");
  command.add_option("--camera-target", target, "Point in the middle of the picture x,y,z");
  command.add_option("--camera-up", up,
                     "Up direction x,y,z (without it: that of the cameras, else as the file says, or as the "
                     "scene seems to stand)");
  command.add_option("--camera-fov", fov_y_deg, "Vertical field of view, degrees")->check(within(1, 170));
  command.add_option("--size", size, "Picture size WxH");
}

std::optional<glm::dvec3> three_numbers(const std::string& text) {
  glm::dvec3 v;
  char rest = 0;
  const bool three = std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &v.x, &v.y, &v.z, &rest) == 3;
  return three && std::isfinite(v.x + v.y + v.z) ? std::optional(v) : std::nullopt;
}

glm::dvec3 parse_vec3(const std::string& text, const std::string& where) {
  const std::optional<glm::dvec3> point = three_numbers(text);
  if (!point) throw Error(where + " " + text, "is not a point", "Write it as x,y,z");
  return *point;
}

void check_picture(const Camera& camera, std::size_t pixel_bytes) {
  constexpr double kGb = 1e9;
  const double needed =
      static_cast<double>(camera.width_px) * camera.height_px * static_cast<double>(pixel_bytes);
  const std::optional<std::uint64_t> free = available_memory();
  if (!free || needed <= static_cast<double>(*free)) return;
  throw Error(camera.name.empty() ? "picture" : fmt::format("camera \"{}\"", camera.name),
              fmt::format("its picture of {} x {} pixels takes {:.1f} GB of memory, and {:.1f} GB are free",
                          camera.width_px, camera.height_px, needed / kGb, static_cast<double>(*free) / kGb),
              "Give a smaller one with --size");
}

ChosenCamera choose_camera(const CameraOptions& options, const Scene& scene) {
  const GaussianCloud& cloud = scene.cloud;
  const glm::dvec3& origin = scene.origin;
  ChosenCamera chosen;
  if (!options.camera.empty() && options.cameras.empty())
    throw Error("--camera " + options.camera, "names a camera, but none are given",
                "Give them with --cameras");
  if (!options.cameras.empty()) {
    chosen.given = load_cameras(options.cameras, &chosen.warning, origin);
    if (chosen.given.empty()) throw Error(options.cameras.string(), "holds no camera");
    chosen.up_world = common_up(chosen.given);
    if (!any_sees(chosen.given, cloud))
      add_sentence(
          options.cameras.string() +
              ": its cameras see nothing of the scene: they may be of another run, or the scene was moved",
          &chosen.warning);
  }
  if (!options.up.empty()) {
    const glm::dvec3 up = parse_vec3(options.up, "--camera-up");
    if (!(glm::length(up) > 0) || !std::isfinite(glm::length(up)))
      throw Error("--camera-up " + options.up, "is no direction", "Write one as x,y,z, as in 0,-1,0");
    chosen.up_world = glm::normalize(up);
  } else if (chosen.given.empty()) {
    chosen.up_is_guess = !scene.up;
    chosen.up_world = scene.up ? *scene.up : guessed_up(cloud);
  }
  constexpr float kDefaultFovDeg = 50;
  const float fov_y_rad = glm::radians(options.fov_y_deg.value_or(kDefaultFovDeg));
  const auto [width, height] =
      options.size.empty() ? std::pair(kDefaultWidth, kDefaultHeight) : parse_size(options.size);
  if (!options.camera.empty() && !options.position.empty())
    throw Error("camera", "--camera and --camera-pos name two views", "Give one of them");
  if (!options.position.empty() || !options.target.empty()) {
    if (options.position.empty() || options.target.empty())
      throw Error("camera", "--camera-pos and --camera-target belong together", "Give both");
    const glm::vec3 position = parse_vec3(options.position, "--camera-pos") - origin,
                    target = parse_vec3(options.target, "--camera-target") - origin;
    chosen.camera = look_at(position, target, up_for(options, target - position, chosen.up_world), fov_y_rad,
                            width, height);
  } else if (!chosen.given.empty()) {
    if (options.fov_y_deg)
      throw Error("--camera-fov", "cannot go with a camera of --cameras, which has its own",
                  "Leave it out, or give --camera-pos and --camera-target");
    chosen.camera = asked_camera(options, chosen);
    if (!options.size.empty()) chosen.camera = resized(chosen.camera, width, height);
  } else {
    chosen.camera = first_view(cloud, chosen.up_world, fov_y_rad, width, height);
  }
  return chosen;
}

}  // namespace splatcut
