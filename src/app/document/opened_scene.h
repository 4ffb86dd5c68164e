// A scene as the window and `splatcut cut --work` open it: one or more files, their capture cameras, an up
// direction.
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
  std::uint64_t serial = 0;  // number that differs for every scene opened
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const GaussianCloud> cloud;  // cloud of the scene
  std::vector<SceneSource> files;              // files that the scene is made of, one or more
  std::vector<std::string> remarks;  // sentences on oddities of files that were read for the first time
  Box bounds;                        // robust bounds: outliers do not count
  std::shared_ptr<const CloudBlocks> blocks;  // blocks of the cloud

  // Views of the first file; they hold for the whole scene.
  const FileViews& views() const { return *files.front().views; }
  const SceneSource* file(std::uint32_t id) const;  // file of that id; null: there is none
};

// Flags per Gaussian of the scene: 1 if it comes from the file of that id.
std::vector<std::uint8_t> gaussians_of(const OpenedScene& scene, std::uint32_t file);

// Opens files as one scene. before: an open scene that shares some of the files, matched by their ids; null:
// none. Throws Error for a file that is no scene, and for a shared file that has changed on the disk since.
// refused: takes a sentence for each file that is no scene and that is neither the first nor shared, and the
// others are opened without it; null: it throws, too. If cancelled, the result holds no scene.
std::shared_ptr<OpenedScene> open_scene(std::vector<SceneSource> files, const Job& job = {},
                                        const OpenedScene* before = nullptr,
                                        std::vector<std::string>* refused = nullptr);
std::shared_ptr<OpenedScene> open_scene(const std::filesystem::path& file, const Job& job = {});

// Opens one file, in place of one that is no scene the first of `added` that is one, which leaves `added`.
// refused: takes a sentence for each that is none. Throws as open_scene() does; where none of several is a
// scene an Error with all sentences.
std::shared_ptr<OpenedScene> open_first(std::vector<SceneSource> file,
                                        std::vector<std::filesystem::path>* added,
                                        std::vector<std::string>* refused, const Job& job);

std::string described(const OpenedScene& scene);  // what is said of a scene that was opened
// The same of files that were added; before: the scene without them.
std::string added_text(const OpenedScene& scene, const OpenedScene& before);

// Makes a session on the scene. The cameras beside its first file observe what the user clicks.
Session session_on(const OpenedScene& scene, const PreparedCache& cache = {});

// Sentence about the level of detail that was chosen, and why. free_bytes: free memory; none: not known.
std::string remark_on_level(const SceneLevels& levels, unsigned level,
                            const std::optional<std::uint64_t>& free_bytes);

// Capture cameras that lie beside a scene: cameras.json, transforms.json or a COLMAP folder (sparse/0) in its
// folder or one of the two above. Empty if there are none that can be read. origin: as in load_cameras().
// why_none: a sentence about such a file that holds none, if none of them holds any.
std::vector<Camera> cameras_near(const std::filesystem::path& scene, const glm::dvec3& origin = glm::dvec3(0),
                                 std::string* why_none = nullptr);

}  // namespace splatcut
