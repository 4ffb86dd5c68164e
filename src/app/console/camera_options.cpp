#include "app/console/camera_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "scene/camera/camera_file.h"
#include "scene/raster/first_view.h"
#include "scene/raster/guessed_up.h"

namespace splatcut {

namespace {

constexpr int kDefaultWidth = 1008, kDefaultHeight = 756, kMaxSide = 16384;

std::pair<int, int> parse_size(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 || height < 1 ||
      width > kMaxSide || height > kMaxSide)
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

// A guess is no reason to refuse a view straight down.
glm::vec3 up_for(const CameraOptions& options, const glm::vec3& forward, const glm::vec3& up) {
  constexpr float kParallel = 1e-3f;
  const bool parallel =
      glm::length(glm::cross(forward, up)) < kParallel * glm::length(forward) * glm::length(up);
  if (!parallel || !options.up.empty() || !options.cameras.empty()) return up;
  return std::abs(up.y) > 0.5f ? glm::vec3(0, 0, 1) : glm::vec3(0, -1, 0);
}

}  // namespace

void CameraOptions::add_to(CLI::App& command) {
  command.add_option("--cameras", cameras, "cameras.json, transforms.json or a COLMAP folder");
  command.add_option("--camera", camera, "Which of the cameras: its name, or its number from 0");
  command.add_option("--camera-pos", position, "Camera position x,y,z");
  command.add_option("--camera-target", target, "Point in the middle of the picture x,y,z");
  command.add_option("--camera-up", up,
                     "Up direction x,y,z (without it: that of the cameras, or as the scene seems to stand)");
  command.add_option("--camera-fov", fov_y_deg, "Vertical field of view, degrees")
      ->check(CLI::Range(1.0, 170.0));
  command.add_option("--size", size, "Picture size WxH");
}

glm::vec3 parse_vec3(const std::string& text, const std::string& where) {
  glm::vec3 v;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%f,%f,%f%c", &v.x, &v.y, &v.z, &rest) != 3 ||
      !std::isfinite(v.x + v.y + v.z))
    throw Error(where + " " + text, "is not a point", "Write it as x,y,z");
  return v;
}

const Camera& find_camera(const std::vector<Camera>& cameras, const std::string& name,
                          const std::string& where) {
  const auto named = std::ranges::find(cameras, name, &Camera::name);
  if (named != cameras.end()) return *named;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (error == std::errc{} && end == name.data() + name.size() && index < cameras.size())
    return cameras[index];
  if (cameras.empty()) throw Error(where, fmt::format("names the camera \"{}\", but has no cameras", name));
  throw Error(where, fmt::format("has no camera \"{}\"", name),
              fmt::format("It has {}, the first is \"{}\"", cameras.size(), cameras.front().name));
}

ChosenCamera choose_camera(const CameraOptions& options, const GaussianCloud& cloud) {
  ChosenCamera chosen;
  if (!options.cameras.empty()) {
    chosen.given = load_cameras(options.cameras, &chosen.warning);
    if (chosen.given.empty()) throw Error(options.cameras.string(), "holds no camera");
    chosen.up_world = common_up(chosen.given);
  }
  if (!options.up.empty())
    chosen.up_world = parse_vec3(options.up, "--camera-up");
  else if (chosen.given.empty())
    chosen.up_world = guessed_up(cloud);
  const float fov_y_rad = glm::radians(options.fov_y_deg);
  const auto [width, height] =
      options.size.empty() ? std::pair(kDefaultWidth, kDefaultHeight) : parse_size(options.size);
  if (!options.position.empty() || !options.target.empty()) {
    if (options.position.empty() || options.target.empty())
      throw Error("camera", "--camera-pos and --camera-target belong together", "Give both");
    const glm::vec3 position = parse_vec3(options.position, "--camera-pos"),
                    target = parse_vec3(options.target, "--camera-target");
    chosen.camera = look_at(position, target, up_for(options, target - position, chosen.up_world), fov_y_rad,
                            width, height);
  } else if (!chosen.given.empty()) {
    chosen.camera =
        find_camera(chosen.given, options.camera.empty() ? "0" : options.camera, options.cameras.string());
    if (!options.size.empty()) chosen.camera = resized(chosen.camera, width, height);
  } else {
    chosen.camera = first_view(cloud, chosen.up_world, fov_y_rad, width, height);
  }
  return chosen;
}

}  // namespace splatcut
