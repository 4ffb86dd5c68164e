// A scene as the window and `splatcut cut --work` open it: files, capture cameras, up, what is prepared of
// it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/studio/scene_sources.h"
#include "scene/camera/camera.h"
#include "scene/formats/scene_file.h"
#include "segment/session/session.h"

namespace splatcut {

struct OpenedScene {
  std::uint64_t serial = 0;  // differs for every scene opened
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const GaussianCloud> cloud;  // of the scene
  std::vector<SceneSource> files;              // what it is made of, one or more
  std::vector<std::string> remarks;   // a sentence each on what is odd about files read for the first time
  Box bounds;                         // robust: outliers do not count
  std::vector<Camera> observed_from;  // of several files: where each shows its surfaces; see prepare()

  // The first file's say how the whole is looked at.
  const FileViews& views() const { return *files.front().views; }
  const SceneSource* file(std::uint32_t id) const;  // null: none of that id
};

// 1 for each Gaussian of one of its files.
std::vector<std::uint8_t> gaussians_of(const OpenedScene& scene, std::uint32_t file);

// Throws Error for a file that is no scene. Cancelled: the result is empty. before: a scene in which some of
// the files are, known by their ids; Error where one of them has changed since.
std::shared_ptr<OpenedScene> open_scene(std::vector<SceneSource> files, const Job& job = {},
                                        const OpenedScene* before = nullptr);
std::shared_ptr<OpenedScene> open_scene(const std::filesystem::path& file, const Job& job = {});

// Graph and parts. A function of the scene and its cameras alone, so that saved work computes the same again.
std::shared_ptr<const PreparedScene> prepare(const OpenedScene& scene, const Job& job = {},
                                             const PreparedCache& cache = {});

// What a session is made of. The prepared scene: of this scene.
SessionScene session_scene(const OpenedScene& scene, std::shared_ptr<const PreparedScene> prepared);

// Capture cameras beside a scene: cameras.json, transforms.json or a COLMAP folder in its folder or the two
// above.
std::vector<Camera> cameras_near(const std::filesystem::path& scene);

}  // namespace splatcut
