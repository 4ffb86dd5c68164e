// The camera part of the command line: given cameras, a look-at camera, or the view in which the window opens
// a scene without cameras.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/formats/scene_file.h"

namespace CLI {
class App;
}

namespace splatcut {

struct CameraOptions {
  std::string position, target, up;  // "x,y,z"
  std::optional<float> fov_y_deg;
  std::string size;               // "WxH"
  std::filesystem::path cameras;  // file or COLMAP folder
  std::string camera;             // name, or index

  void add_to(CLI::App& command);
};

struct ChosenCamera {
  Camera camera;
  glm::vec3 up_world{0, -1, 0};
  bool up_is_guess = false;   // neither options nor cameras nor the file say it
  std::vector<Camera> given;  // all cameras of --cameras, if any
  std::string warning;        // a sentence about those cameras, or empty
};

// Throws Error for a camera that cannot be made. Scene::origin is taken off all positions that are given.
ChosenCamera choose_camera(const CameraOptions& options, const Scene& scene);

// Throws Error where a picture of the camera, at so many bytes a pixel, needs more memory than is free.
void check_picture(const Camera& camera, std::size_t pixel_bytes);

// Three finite numbers with commas between them.
std::optional<glm::dvec3> three_numbers(const std::string& text);
// The same, else throws Error that names `where`.
glm::dvec3 parse_vec3(const std::string& text, const std::string& where);

}  // namespace splatcut
