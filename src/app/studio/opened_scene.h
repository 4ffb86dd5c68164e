// A scene as the window and `splatcut cut --work` open it: file, capture cameras, up, what is prepared of it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/formats/scene_file.h"
#include "segment/session/session.h"

namespace splatcut {

struct OpenedScene {
  std::uint64_t serial = 0;  // differs for every scene opened
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const GaussianCloud> cloud;  // of the scene
  std::vector<Camera> cameras;                 // of the capture, found beside the file; may be empty
  std::uint64_t hash = 0;                      // of the file
  Box bounds;                                  // robust: outliers do not count
  glm::vec3 up_world{0, -1, 0};                // of the capture, or guessed
  std::optional<Camera>
      first_view;  // set if neither a capture camera nor a view of all from outside is a good start
};

// Throws Error for a file that is no scene. Cancelled: the result is empty. spz_axes: as in LoadOptions.
std::shared_ptr<OpenedScene> open_scene(const std::filesystem::path& file, const Job& job = {},
                                        std::optional<SpzAxes> spz_axes = {});

// Graph and parts. A function of the scene and its cameras alone, so that saved work computes the same again.
std::shared_ptr<const PreparedScene> prepare(const OpenedScene& scene, const Job& job = {},
                                             const PreparedCache& cache = {});

// What a session is made of. The prepared scene: of this scene.
SessionScene session_scene(const OpenedScene& scene, std::shared_ptr<const PreparedScene> prepared);

// Capture cameras beside a scene: cameras.json, transforms.json or a COLMAP folder in its folder or the two
// above.
std::vector<Camera> cameras_near(const std::filesystem::path& scene);

}  // namespace splatcut
