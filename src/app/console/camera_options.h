// The camera part of the command line: given cameras, a look-at camera, or the view in which the window opens
// a scene without cameras.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace CLI {
class App;
}

namespace splatcut {

struct CameraOptions {
  std::string position, target, up;  // "x,y,z"
  float fov_y_deg = 50;
  std::string size;               // "WxH"
  std::filesystem::path cameras;  // file or COLMAP folder
  std::string camera;             // name, or index

  void add_to(CLI::App& command);
};

struct ChosenCamera {
  Camera camera;
  glm::vec3 up_world{0, -1, 0};
  std::vector<Camera> given;  // all cameras of --cameras, if any
  std::string warning;        // a sentence about those cameras, or empty
};

// Throws Error for a camera that cannot be made. origin: taken off all positions that are given, as off those
// of the scene (Scene::origin).
ChosenCamera choose_camera(const CameraOptions& options, const GaussianCloud& cloud,
                           const glm::dvec3& origin = glm::dvec3(0));

glm::dvec3 parse_vec3(const std::string& text, const std::string& where);

}  // namespace splatcut
