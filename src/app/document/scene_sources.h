// The files that the window's scene is made of: the one that was opened, and others added to it, each where
// it was put. Their scene is that of `splatcut merge`: the rows of the first, then of the second, and so on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/document/export_placement.h"
#include "app/document/placing_handles.h"
#include "scene/camera/camera.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// p' = scale R (p - middle) + middle + move, R about x, then y, then z of the world, right-handed.
struct ScenePlace {
  glm::vec3 move{0};  // scene units
  glm::vec3 turn_deg{0};
  float scale = 1;
  bool operator==(const ScenePlace&) const = default;
};

// From where a scene is looked at, in its file's own coordinates.
struct FileViews {
  std::vector<Camera> cameras;   // of the capture, found beside the file; may be empty
  glm::vec3 up_world{0, -1, 0};  // of the capture, or guessed
  // Set if neither a capture camera nor a view of all from outside is a good start.
  std::optional<Camera> first_view;
  Camera reference;  // a capture camera, the first view or the view of all
};

struct SceneSource {
  std::uint32_t id = 0;  // tells the files of a window apart, differs for every file opened
  std::filesystem::path path;
  std::optional<SpzAxes> spz_axes;  // as LoadOptions; once loaded, those of a file that does not say them
  ScenePlace place;                 // the first file stays where it is

  // Once it is loaded.
  std::uint64_t hash = 0;  // hash_of_file(); not 0 before: the file must be that one
  std::size_t file_rows = 0, gaussians = 0;
  std::shared_ptr<const FileViews> views;
  Box bounds;  // framed_bounds() before it was placed; around the middle it is turned and scaled
};

// Throws Error for numbers that no scene can be placed by.
void check(const ScenePlace& place, const std::filesystem::path& file);

Similarity similarity_of(const SceneSource& file);
// From where the file stands in `before` to where it stands in `after`.
Similarity similarity_between(const SceneSource& before, const SceneSource& after);

// After a drag of handles whose centre is the file's middle where it stands.
ScenePlace changed(ScenePlace place, const PlacingChange& change);

// The same place, but that the file's own way up is `up_world`.
ScenePlace stood_upright(const SceneSource& file, ScenePlace place, const glm::vec3& up_world);
// The same, but that the file's box stands on the point: its middle lies above that by half of what the box
// measures along up_world.
ScenePlace stood_on(SceneSource file, const ScenePlace& place, const glm::vec3& point_world,
                    const glm::vec3& up_world);

// Sees of a moved scene what the camera sees of the scene.
Camera moved(const Camera& camera, const Similarity& to);

}  // namespace splatcut
