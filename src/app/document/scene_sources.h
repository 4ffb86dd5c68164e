// Files that the window's scene is made of: the opened file, and files added to it, each with its place.
// Their scene is what `splatcut merge` makes of them: the rows of the first file, then those of the second,
// and so on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/placing/export_placement.h"
#include "app/placing/placing_handles.h"
#include "scene/camera/camera.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// Place of a file in the scene: p' = scale R (p - middle) + middle + move, with middle that of
// SceneSource::bounds, and R a right-handed rotation about x, then y, then z of the world.
struct ScenePlace {
  glm::vec3 move{0};      // translation, scene units
  glm::vec3 turn_deg{0};  // angles about x, y and z
  float scale = 1;
  bool operator==(const ScenePlace&) const = default;
};

// Where a file that is added comes to stand, upright: its foot on the point. With a row, files that are added
// together stand beside one another in that direction, across up, by their boxes.
struct StandsOn {
  glm::vec3 point_world, up_world;
  glm::vec3 row_world{0};     // direction of the row, unit length; 0: none
  bool begins_there = false;  // the row begins at the point; else the point is in its middle
  // Where a file stands, without the row, that is small against the first of the scene; none: in the row.
  std::optional<glm::vec3> small_on_world = {};
};

// Views of a file's scene, in the file's own coordinates.
struct FileViews {
  std::vector<Camera> cameras;   // capture cameras found beside the file; may be empty
  glm::vec3 up_world{0, -1, 0};  // up direction: as the file says, of the capture, or a guess
  bool up_is_guess = false;      // neither the file nor cameras say it
  bool up_is_unsure = false;     // it is a guess, and no clear one
  // Guessed start of the window, if there are no cameras and a view of all from outside is a bad start.
  std::optional<Camera> first_view;
  Camera reference;  // start of the window: a capture camera, first_view, or a view of all
};

struct SceneSource {
  std::uint32_t id = 0;  // number that differs for every file that a window opens
  std::filesystem::path path;
  // Axes to read a .spz with, as in LoadOptions. After loading: the axes taken, if the file does not say
  // them.
  std::optional<SpzAxes> spz_axes;
  std::filesystem::path cameras = {};  // file or folder that was asked for; empty: those beside the scene
  std::string camera = {};             // the one to begin with, by name or number; empty: the first
  // Level of detail to read, of a file that has several; after loading: the level read.
  std::optional<unsigned> lod;
  // Taken off positions, as in LoadOptions; after loading: that of the scene, which is the first file's.
  std::optional<glm::dvec3> origin;
  ScenePlace place;  // place in the scene; the first file always stays where its coordinates say
  std::optional<StandsOn> onto = {};  // loading sets the place by it
  std::uint32_t fills = 0;            // ObjectId of the object whose hole it was kept to fill; 0: none

  // Loading sets the rest.
  std::uint64_t hash = 0;  // hash_of_file(); in a work file the hash that the file must have
  std::size_t file_rows = 0, gaussians = 0;
  SceneLevels levels;  // none of a file that has one
  std::shared_ptr<const FileViews> views;
  bool cameras_are_others = false;  // those beside it stand otherwise than it says of up, and are left out
  Box bounds;  // framed_bounds() of the file before it is placed; `place` turns and scales about its middle
  Box solid;  // solid_bounds() of a file that was added, before it is placed: what it stands on, what is seen
};

// Checks a place: throws Error if a number is out of range or not finite. file: named by the Error.
void check(const ScenePlace& place, const std::filesystem::path& file);

// The transform from the file's own coordinates to the scene's.
Similarity similarity_of(const SceneSource& file);
// The transform from the file's place in `before` to its place in `after`.
Similarity similarity_between(const SceneSource& before, const SceneSource& after);

// The place after a drag of handles whose centre is the placed middle of the file. Scaled, the file stays on
// its foot, as it does by numbers.
ScenePlace changed(const SceneSource& file, ScenePlace place, const PlacingChange& change,
                   const glm::vec3& up_world);

// The place, turned so that the file's own up becomes `up_world`.
ScenePlace stood_upright(const SceneSource& file, ScenePlace place, const glm::vec3& up_world);
// Why stood_upright() has nothing to turn, in a sentence; empty: it has. It leaves the way that an upright
// file faces as it is.
std::string why_upright(const SceneSource& file, const ScenePlace& place, const glm::vec3& up_world);
// The lowest point of the placed file: below the middle of its solid box, by half of the box's extent along
// up.
glm::vec3 foot_world(const SceneSource& file, const glm::vec3& up_world);
// Half of the placed file's extent along a direction of unit length.
float half_extent(const SceneSource& file, const glm::vec3& direction_world);
// Sets the places of files with `onto` by it; those with a row are one row.
void stand(std::vector<SceneSource>* files);
// Where a row beside the files of a scene begins, on the height of the first one's foot.
StandsOn beside(std::span<const SceneSource> files, const glm::vec3& row_world, const glm::vec3& up_world);
// The place, moved so that the file's foot comes to the point.
ScenePlace stood_on(SceneSource file, const ScenePlace& place, const glm::vec3& point_world,
                    const glm::vec3& up_world);
// The place at another scale, about the file's foot.
ScenePlace scaled_on_foot(SceneSource file, const ScenePlace& place, float scale, const glm::vec3& up_world);

// The longest side of the placed file as a share of the picture's height at the distance of its foot.
float share_of_picture(const SceneSource& file, const Camera& camera, const glm::vec3& up_world);
// The place at which that share is a half, about the foot.
ScenePlace fitted(const SceneSource& file, const Camera& camera, const glm::vec3& up_world);
// A sentence where a placed file is so large or small that the camera shows little of it; else empty.
std::string misfit(const SceneSource& file, const Camera& camera, const glm::vec3& up_world);

// The camera that sees the transformed scene as `camera` sees the scene.
Camera moved(const Camera& camera, const Similarity& to);

}  // namespace splatcut
