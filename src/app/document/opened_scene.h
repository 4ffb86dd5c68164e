// A scene as the window and `splatcut cut --work` open it: files, capture cameras, up.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/document/scene_sources.h"
#include "scene/camera/camera.h"
#include "scene/formats/scene_file.h"
#include "segment/session/session.h"

namespace splatcut {

struct OpenedScene {
  std::uint64_t serial = 0;  // differs for every scene opened
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const GaussianCloud> cloud;  // of the scene
  std::vector<SceneSource> files;              // what it is made of, one or more
  std::vector<std::string> remarks;  // a sentence each on what is odd about files read for the first time
  Box bounds;                        // robust: outliers do not count
  std::shared_ptr<const CloudBlocks> blocks;  // of the cloud

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

// A session on it. The cameras beside its first file observe what is clicked.
Session session_on(const OpenedScene& scene, const PreparedCache& cache = {});

// Capture cameras beside a scene: cameras.json, transforms.json or a COLMAP folder in its folder or the two
// above.
std::vector<Camera> cameras_near(const std::filesystem::path& scene);

}  // namespace splatcut
